// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/python/to_python.hpp"

#include <pybind11/numpy.h>
#include <yaml-cpp/yaml.h>

#include <cstddef>
#include <cstdint>

namespace crisp::python {
namespace {

namespace py = pybind11;

py::object scalar(const YAML::Node& node) {
  std::int64_t whole = 0;
  double number = 0;
  bool truth = false;
  const bool is_quoted = node.Tag() == "!";
  if (!is_quoted && YAML::convert<std::int64_t>::decode(node, whole)) return py::int_(whole);
  if (!is_quoted && YAML::convert<double>::decode(node, number)) return py::float_(number);
  if (!is_quoted && YAML::convert<bool>::decode(node, truth)) return py::bool_(truth);
  return py::str(node.Scalar());
}

py::object as_object(const YAML::Node& node) {
  if (node.IsMap()) {
    py::dict map;
    for (const auto& entry : node) map[py::str(entry.first.Scalar())] = as_object(entry.second);
    return map;
  }
  if (node.IsSequence()) {
    py::list list;
    for (const auto& entry : node) list.append(as_object(entry));
    return list;
  }
  return node.IsScalar() ? scalar(node) : py::none();
}

struct Field {
  const char* name;
  const char* format;  ///< numpy's
  std::size_t offset;
};

/// A view of n rows from `first` on, which keeps the owner.
template <class Row, class Owner>
py::object view(std::initializer_list<Field> fields, const Row* first, std::size_t n,
                std::shared_ptr<Owner> owner) {
  py::list names;
  py::list formats;
  py::list offsets;
  for (const auto& field : fields) {
    names.append(field.name);
    formats.append(field.format);
    offsets.append(field.offset);
  }
  const py::dtype type(names, formats, offsets, sizeof(Row));
  const py::capsule keep(new std::shared_ptr<Owner>(std::move(owner)),
                         [](void* held) { delete static_cast<std::shared_ptr<Owner>*>(held); });
  py::array array(type, {n}, {sizeof(Row)}, first, keep);
  array.attr("flags").attr("writeable") = false;
  return array;
}

}  // namespace

py::object parsed(const std::string& text) { return as_object(YAML::Load(text)); }

py::object as_array(std::shared_ptr<const Cloud> cloud) {
  if (!cloud) return py::none();
  const Point* first = cloud->points.data();
  const std::size_t n = cloud->points.size();
  return view({{"x", "<f4", offsetof(Point, x)},
               {"y", "<f4", offsetof(Point, y)},
               {"z", "<f4", offsetof(Point, z)},
               {"intensity", "<f4", offsetof(Point, intensity)},
               {"laser", "<u2", offsetof(Point, laser)},
               {"beam", "<u2", offsetof(Point, beam)},
               {"time", "<f8", offsetof(Point, time)}},
              first, n, std::move(cloud));
}

py::object as_array(std::shared_ptr<const std::vector<MeasurementRow>> rows) {
  if (!rows) return py::none();
  const MeasurementRow* first = rows->data();
  const std::size_t n = rows->size();
  return view({{"time", "<f8", offsetof(MeasurementRow, time)},
               {"range", "<f4", offsetof(MeasurementRow, range)},
               {"mirror_angle", "<f4", offsetof(MeasurementRow, mirror_angle)},
               {"remission", "<f4", offsetof(MeasurementRow, remission)},
               {"laser", "<u2", offsetof(MeasurementRow, laser)},
               {"beam", "<u2", offsetof(MeasurementRow, beam)}},
              first, n, std::move(rows));
}

py::dict as_dict(const Error& error) {
  py::dict dict;
  dict["message"] = error.message();
  dict["advice"] = error.advice();
  dict["file"] = error.place().file;
  dict["line"] = error.place().line;
  dict["column"] = error.place().column;
  if (const auto* several = dynamic_cast<const Errors*>(&error)) {
    py::list all;
    for (const auto& each : several->all()) all.append(as_dict(each));
    dict["all"] = all;
  }
  return dict;
}

}  // namespace crisp::python
