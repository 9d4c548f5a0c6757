// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/app/status_board.hpp"

#include <fmt/format.h>

namespace crisp::app {
namespace {

/// A text between the quotes of a label.
std::string label(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '\\' || c == '"') escaped += '\\';
    if (c == '\n') {
      escaped += "\\n";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

}  // namespace

void StatusBoard::set_status(const std::string& tag, const StageStatus& status) {
  const std::lock_guard lock(mutex_);
  reported_[tag] = status;
}

std::string StatusBoard::line() const {
  const std::lock_guard lock(mutex_);
  std::string line;
  for (const auto& tag : tags_) {
    const auto reported = reported_.find(tag);
    if (reported == reported_.end() || reported->second.line.empty()) continue;
    line += (line.empty() ? "" : " | ") + reported->second.line;
  }
  return line;
}

std::string StatusBoard::prometheus() const {
  const std::lock_guard lock(mutex_);
  std::map<std::string, std::string> metrics;  // the samples of a metric stand together
  for (const auto& [tag, status] : reported_) {
    for (const Gauge& gauge : status.gauges) {
      const std::string device =
          gauge.device.empty() ? "" : fmt::format(",device=\"{}\"", label(gauge.device));
      metrics[gauge.name] +=
          fmt::format("crisp_{}{{stage=\"{}\"{}}} {}\n", gauge.name, label(tag), device, gauge.value);
    }
  }
  std::string text;
  for (const auto& [name, samples] : metrics) {
    text +=
        fmt::format("# TYPE crisp_{} {}\n{}", name, name.ends_with("_total") ? "counter" : "gauge", samples);
  }
  return text;
}

}  // namespace crisp::app
