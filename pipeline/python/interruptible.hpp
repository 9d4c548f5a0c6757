// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <future>
#include <optional>
#include <utility>

namespace crisp::python {

/// Does the work in a thread of its own while other threads of Python run. What a signal's handler raises, as
/// Ctrl-C KeyboardInterrupt, sets `stop`, and is raised once the work has ended.
/// @throws what the work throws
template <class Work>
void run_interruptibly(Work work, std::atomic<bool>& stop) {
  namespace py = pybind11;
  constexpr auto kBetweenChecks = std::chrono::milliseconds(50);
  std::future<void> done = std::async(std::launch::async, std::move(work));
  std::optional<py::error_already_set> raised;
  for (bool is_done = false; !is_done;) {
    {
      const py::gil_scoped_release others_run;
      is_done = done.wait_for(kBetweenChecks) == std::future_status::ready;
    }
    if (raised || PyErr_CheckSignals() == 0) continue;
    raised.emplace();
    stop = true;
  }
  try {
    done.get();
  } catch (...) {
    if (!raised) throw;
  }
  if (raised) throw py::error_already_set(*raised);
}

}  // namespace crisp::python
