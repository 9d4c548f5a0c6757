// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>

#include "pipeline/app/metrics_server.hpp"
#include "pipeline/app/progress.hpp"
#include "pipeline/app/status_board.hpp"
#include "pipeline/batch/run_batch.hpp"

namespace crisp::app {

/// Shows how far a batch is: a bar on the standard error, and numbers for Prometheus.
class BatchDisplay {
 public:
  /// @param metrics  port at 127.0.0.1 for a program that watches
  BatchDisplay(bool quiet, std::optional<std::uint16_t> metrics);

  /// @param stop  set when the batch is to stop; must outlive the hooks, as this must
  batch::BatchHooks hooks(const std::atomic<bool>* stop);

 private:
  void show(const batch::BatchProgress& progress);

  bool quiet_;
  double began_;
  StatusBoard board_;
  std::optional<MetricsServer> metrics_;
  ProgressPrinter printer_;
};

}  // namespace crisp::app
