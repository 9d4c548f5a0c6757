// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pybind11/pybind11.h>

#include <string>

#include <crisp/error.hpp>

#include "pipeline/python/result_collector.hpp"

namespace crisp::python {

/// YAML, or JSON, as dicts, lists, numbers and texts.
pybind11::object parsed(const std::string& text);

/// n rows x, y, z, intensity, laser, beam, time: a read-only view of the cloud's own memory, which it keeps.
pybind11::object as_array(std::shared_ptr<const Cloud> cloud);

/// n rows time, range, mirror_angle, remission, laser, beam, in the same way.
pybind11::object as_array(std::shared_ptr<const std::vector<MeasurementRow>> rows);

/// A dict of message, advice, file, line, column; of several errors also `all`, a list of such.
pybind11::dict as_dict(const Error& error);

}  // namespace crisp::python
