// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/report/run_inspector.hpp"

#include <fmt/format.h>

#include "pipeline/files/json_text.hpp"
#include "plugins/report/use_json.hpp"

namespace crisp::report {
namespace {

using Json = nlohmann::ordered_json;

/// Recognizes the first keys that a run writes.
bool is_run(std::string_view head) {
  const std::string packed = files::without_space(head);
  return packed.starts_with(R"({"crisp":")") && packed.find(R"(,"command":")") != std::string::npos &&
         packed.find(R"(,"pipeline":")") != std::string::npos;
}

std::string text_of(const Json& run) {
  std::string text =
      fmt::format("  {}\n  began {}, took {:.1f} s, exit status {}, {}", run.at("command").get<std::string>(),
                  run.at("started").get<std::string>(), run.at("seconds").get<double>(),
                  run.at("exit_status").get<int>(), run.at("trusted").get<bool>() ? "trusted" : "untrusted");
  if (run.contains("error")) text += fmt::format("\n  error: {}", run["error"].get<std::string>());
  for (const Json& input : run.at("inputs"))
    text += fmt::format("\n  read {}", input.at("file").get<std::string>());
  for (const Json& stage : run.at("stages")) {
    const auto tag = stage.at("tag").get<std::string>();
    for (const Json& caveat : stage.at("caveats"))
      text += fmt::format("\n  {}: untrusted: {}", tag, caveat.get<std::string>());
    for (const Json& warning : stage.at("warnings"))
      text += fmt::format("\n  {}: warning: {}", tag, warning.get<std::string>());
    for (const Json& output : stage.at("outputs"))
      text += fmt::format("\n  {} wrote {}", tag, output.get<std::string>());
  }
  return text;
}

Inspection inspect_run(const std::filesystem::path& file, const Rig&) {
  return use_json(file, [](const Json& run) { return Inspection{.text = text_of(run), .data = run}; });
}

}  // namespace

Inspector run_inspector() { return {"a run's summary", is_run, inspect_run}; }

}  // namespace crisp::report
