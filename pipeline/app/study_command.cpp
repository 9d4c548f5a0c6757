// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/app/study_command.hpp"

#include <fmt/format.h>

#include "pipeline/batch/effective_settings.hpp"
#include "pipeline/batch/shard.hpp"

namespace crisp::app {
namespace {

constexpr const char* kParts = "parts";

/// The digest of all that the results depend on, wherever they go.
std::string settings_of(const RunRequest& request, const Registrar& registrar) {
  PipelineArguments arguments = request.arguments;
  arguments.output = "/${output}";
  RunSettings run;
  run.registrar = &registrar;
  return batch::digest_of_settings(
      batch::effective_settings(load_pipeline(request.text, request.file, arguments, run), request.seed));
}

}  // namespace

ExitStatus study_command(StudyRequest request, const Registrar& registrar) {
  if (request.shard.empty() && !request.merge) return run_command(request.run, registrar);
  auto& output = request.run.arguments.output;
  const auto set = [&](const std::string& option, const std::string& value) {
    request.run.arguments.set.push_back(request.stage + "." + option + "=" + value);
  };
  try {
    const std::string key = settings_of(request.run, registrar);
    if (request.merge) {
      set("merge", (*output / kParts).string());
    } else {
      const batch::Shard shard = batch::parse_shard(request.shard);
      set("part", shard.text());
      output = *output / kParts / fmt::format("{}-of-{}", shard.number, shard.count);
    }
    set("part_key", key);
  } catch (const Error& error) {
    print_errors(error);
    return ExitStatus::misused;
  }
  return run_command(request.run, registrar);
}

}  // namespace crisp::app
