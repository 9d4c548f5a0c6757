// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <atomic>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <crisp/builtin.hpp>
#include <crisp/calibration_file.hpp>
#include <crisp/rqe.hpp>

#include "pipeline/app/installed_pipelines.hpp"
#include "pipeline/app/recorded_run.hpp"
#include "pipeline/files/findings_file.hpp"
#include "pipeline/files/json_text.hpp"
#include "pipeline/python/interruptible.hpp"
#include "pipeline/python/to_python.hpp"

namespace crisp::python {
namespace {

namespace py = pybind11;
namespace fs = std::filesystem;

struct Request {
  fs::path pipeline;  ///< a file or a name; of a text what it is called
  std::string text;   ///< empty: that of the file
  PipelineArguments arguments;
  std::vector<fs::path> plugins;
  std::optional<unsigned> threads;
  std::uint64_t seed = 1;
};

void load_plugins(const std::vector<fs::path>& files, Registrar& registrar) {
  PluginLoader loader(registrar);
  for (const auto& file : files) loader.load(file);
  for (const auto& plugin : loader.tried()) {
    if (!plugin.refusal.empty())
      throw Error("the plugin " + plugin.file.string() + " was refused: " + plugin.refusal,
                  "correct the plugin, or leave it out");
  }
}

/// Pipelines of this module, wherever it is installed, or of its build tree.
app::InstalledPipelines pipelines_of_module() {
  const fs::path module = py::module_::import("crisp._crisp").attr("__file__").cast<std::string>();
  return app::InstalledPipelines::of_folder(module.parent_path(), CRISP_CONFIGS_FROM_MODULE);
}

app::RunRequest run_request(const Request& request) {
  app::RunRequest run;
  run.file = request.text.empty() ? pipelines_of_module().find(request.pipeline) : request.pipeline;
  run.text = request.text;
  run.arguments = request.arguments;
  run.threads = request.threads.value_or(std::max(1U, std::thread::hardware_concurrency()));
  run.seed = request.seed;
  return run;
}

void run_and_keep(app::RecordedRun& run, Results& results, const std::atomic<bool>& stop) {
  app::RunRecord& record = run.record();
  std::optional<Error> unwritten;
  const auto keep = [&] { run.keep([&](const Error& error) { unwritten = error; }); };
  const auto fail = [&](const std::string& why) {
    record.failure = why;
    record.exit_status = static_cast<int>(app::ExitStatus::failed);
    keep();
  };
  try {
    run.run(
        {.stop = &stop, .given = [&](const std::string& tag, const Item& item) { results.take(tag, item); }});
  } catch (const Interrupted&) {
    fail("interrupted");
    throw;
  } catch (const Error& error) {
    fail(app::error_text(error));
    throw;
  }
  record.exit_status =
      static_cast<int>(record.is_trusted() ? app::ExitStatus::done : app::ExitStatus::not_trusted);
  keep();
  if (unwritten) throw Error(*unwritten);
}

py::dict run(const Request& request) {
  Builtin builtin;
  load_plugins(request.plugins, builtin.registrar());
  const app::RunRequest requested = run_request(request);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  std::max(1U, requested.threads));
  app::RecordedRun recorded(requested, builtin.registrar());
  Results results(recorded.pipeline());
  std::atomic<bool> stop = false;
  run_interruptibly([&] { run_and_keep(recorded, results, stop); }, stop);

  py::dict dict;
  dict["summary"] = parsed(files::json_text(app::summary_json(recorded.record()), 2));
  dict["cloud"] = as_array(results.cloud());
  dict["measurements"] = as_array(results.rows());
  dict["calibration"] = results.calibration() ? parsed(to_yaml(*results.calibration())) : py::none();
  dict["diagnosis"] = results.findings() ? parsed(files::findings_json(*results.findings())) : py::none();
  dict["epoch_ns"] = results.epoch_ns();
  return dict;
}

py::tuple rqe_of_array(const py::array_t<double, py::array::c_style | py::array::forcecast>& points,
                       double sigma) {
  if (points.ndim() != 2 || points.shape(1) != 3) {
    throw Error(fmt::format("the points have {} dimensions and {} values", points.ndim(), points.size()),
                "give an array of n rows x, y, z");
  }
  const auto row = points.unchecked<2>();
  const auto n = static_cast<std::size_t>(points.shape(0));
  Vectors vectors;
  vectors.assign(n, 0);
  for (py::ssize_t i = 0; i < points.shape(0); ++i) {
    vectors.x[static_cast<std::size_t>(i)] = row(i, 0);
    vectors.y[static_cast<std::size_t>(i)] = row(i, 1);
    vectors.z[static_cast<std::size_t>(i)] = row(i, 2);
  }
  Rqe result;
  {
    const py::gil_scoped_release others_run;
    result = rqe(vectors.view(), {}, {.sigma = sigma});
  }
  py::array_t<double> gradient({static_cast<py::ssize_t>(n), py::ssize_t{3}});
  auto out = gradient.mutable_unchecked<2>();
  for (py::ssize_t i = 0; i < points.shape(0); ++i) {
    out(i, 0) = result.gradient.x[static_cast<std::size_t>(i)];
    out(i, 1) = result.gradient.y[static_cast<std::size_t>(i)];
    out(i, 2) = result.gradient.z[static_cast<std::size_t>(i)];
  }
  return py::make_tuple(result.value, gradient);
}

}  // namespace
}  // namespace crisp::python

PYBIND11_MODULE(_crisp, module) {
  namespace py = pybind11;
  using crisp::python::Request;
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      std::rethrow_exception(std::move(thrown));
    } catch (const crisp::Error& error) {
      PyErr_SetObject(py::module_::import("crisp").attr("Error").ptr(), crisp::python::as_dict(error).ptr());
    }
  });
  module.def(
      "run",
      [](const std::filesystem::path& pipeline, const std::string& text,
         const std::optional<std::filesystem::path>& input,
         const std::optional<std::filesystem::path>& output, const std::optional<std::filesystem::path>& rig,
         const std::vector<std::string>& set, const std::vector<std::filesystem::path>& plugins,
         std::optional<unsigned> threads, std::uint64_t seed) {
        return crisp::python::run({.pipeline = pipeline,
                                   .text = text,
                                   .arguments = {.input = input, .output = output, .rig = rig, .set = set},
                                   .plugins = plugins,
                                   .threads = threads,
                                   .seed = seed});
      },
      py::arg("pipeline"), py::arg("text"), py::arg("input"), py::arg("output"), py::arg("rig"),
      py::arg("set"), py::arg("plugins"), py::arg("threads"), py::arg("seed"));
  module.def("rqe", &crisp::python::rqe_of_array, py::arg("points"), py::arg("sigma"));
  module.attr("version") = CRISP_VERSION;
}
