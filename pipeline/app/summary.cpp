// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/app/summary.hpp"

#include <fmt/format.h>

#include <algorithm>

#include <crisp/calibration.hpp>
#include <crisp/stage.hpp>

#include "pipeline/app/format.hpp"
#include "pipeline/files/json_text.hpp"

namespace crisp::app {
namespace {

/// The text with every line indented.
std::string indented(const std::string& text, const std::string& by) {
  std::string result = by;
  for (const char c : text) {
    result += c;
    if (c == '\n') result += by;
  }
  return result + "\n";
}

std::string flow_text(const NodeResult& node) {
  std::string text;
  for (const auto& [kind, count] : node.taken) text += fmt::format("took {} {}  ", format_count(count), kind);
  for (const auto& [kind, count] : node.given) text += fmt::format("gave {} {}  ", format_count(count), kind);
  return text.empty() ? text : indented(text.substr(0, text.size() - 2), "  ");
}

std::string stage_summary(const NodeResult& node, const nlohmann::ordered_json& options, bool verbose) {
  std::string text;
  if (verbose) {
    text += flow_text(node);
    for (const auto& [name, value] : options.items())
      text += fmt::format("  {} = {}\n", name, files::json_text(value));
  }
  for (const auto& caveat : node.report.caveats) text += indented("UNTRUSTED: " + caveat, "  ");
  for (const auto& line : node.report.lines) text += indented(line, "  ");
  for (const auto& [name, count] : node.report.counts) {
    if (count > 0 || verbose) text += fmt::format("  {:>10}  {}\n", format_count(count), name);
  }
  for (const auto& warning : node.report.warnings) text += indented("warning: " + warning, "  ");
  for (const auto& file : node.report.written) text += fmt::format("  wrote {}\n", file.string());
  return fmt::format("{:<40}{:>12}\n{}", node.tag, format_duration(node.seconds), text);
}

std::size_t warnings_of(const RunRecord& record) {
  std::size_t count = 0;
  for (const NodeResult& node : record.nodes) count += node.report.warnings.size();
  return count;
}

}  // namespace

std::string summary_text(const RunRecord& record, bool verbose) {
  std::string text = fmt::format("crisp {}: {}\n\n", CRISP_VERSION, record.pipeline_file.filename().string());
  for (std::size_t i = 0; i < record.nodes.size(); ++i) {
    text += stage_summary(record.nodes[i], record.options[i], verbose);
  }
  text += fmt::format("{:<40}{:>12}\n", "in all", format_duration(record.seconds));
  const bool calibrates = std::ranges::any_of(record.nodes, [](const NodeResult& node) {
    return node.given.contains(std::string(KindName<Calibration>::value));
  });
  if (!record.is_trusted())
    text += "The result is UNTRUSTED: see the caveats above.\n";
  else if (calibrates && warnings_of(record) > 0)
    text += "The result is trusted, with the warnings above.\n";
  else if (calibrates)
    text += "The result is trusted.\n";
  return text;
}

std::string failure_text(const RunRecord& record) {
  std::string text;
  for (const auto& node : record.nodes) {
    for (const auto& [name, count] : node.report.counts) {
      if (count > 0) text += fmt::format("{}: {} {}\n", node.tag, format_count(count), name);
    }
  }
  return text + warnings_text(record);
}

std::string warnings_text(const RunRecord& record) {
  std::string text;
  for (const auto& node : record.nodes) {
    for (const auto& warning : node.report.warnings)
      text += fmt::format("warning: {}: {}\n", node.tag, warning);
    for (const auto& caveat : node.report.caveats)
      text += fmt::format("untrusted: {}: {}\n", node.tag, caveat);
  }
  return text;
}

}  // namespace crisp::app
