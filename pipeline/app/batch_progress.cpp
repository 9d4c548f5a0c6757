// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/app/batch_progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <iostream>

#include "pipeline/app/terminal.hpp"

namespace crisp::app {
namespace {

std::string in_words(const batch::BatchProgress& progress, double elapsed) {
  std::string text = fmt::format("{} of {}, {} untrusted, {} failed", progress.ended(), progress.total,
                                 progress.untrusted, progress.failed);
  constexpr double kEnoughToJudge = 1;  // [s]
  if (elapsed >= kEnoughToJudge && progress.ended() > 0)
    text += fmt::format(", {:.3g}/s", static_cast<double>(progress.ended()) / elapsed);
  return text;
}

StageStatus as_gauges(const batch::BatchProgress& progress) {
  StageStatus status;
  const auto add = [&](const char* name, std::size_t value) {
    status.gauges.push_back({.name = name, .value = static_cast<double>(value)});
  };
  add("batch_recordings", progress.total);
  add("batch_done_total", progress.done);
  add("batch_untrusted_total", progress.untrusted);
  add("batch_failed_total", progress.failed);
  add("batch_running", progress.running);
  return status;
}

}  // namespace

BatchDisplay::BatchDisplay(bool quiet, std::optional<std::uint16_t> metrics)
    : quiet_(quiet),
      began_(seconds_now()),
      board_({"batch"}),
      printer_(std::cerr, isatty(STDERR_FILENO) == 1, seconds_now, terminal_width()) {
  if (metrics) metrics_.emplace(*metrics, [this] { return board_.prometheus(); });
}

void BatchDisplay::show(const batch::BatchProgress& progress) {
  if (metrics_) board_.set_status("batch", as_gauges(progress));
  if (quiet_) return;
  const std::string text = in_words(progress, seconds_now() - began_);
  printer_.show("batch", {.done = static_cast<double>(progress.ended()),
                          .total = static_cast<double>(progress.total),
                          .what = text});
}

batch::BatchHooks BatchDisplay::hooks(const std::atomic<bool>* stop) {
  return {.stop = stop,
          .progress = [this](const batch::BatchProgress& progress) { show(progress); },
          .log = [this](const std::string& line) { printer_.log(line); }};
}

}  // namespace crisp::app
