// SPDX-License-Identifier: BSD-3-Clause
// diagnose_capture HUB.pcap [PLUGIN.so]: which effects of the scanner the sensor model lacks, with their
// sizes. A pipeline runs in the program: the same stages that a YAML file names.
#include <cstdlib>
#include <exception>
#include <iostream>
#include <memory>
#include <string>
#include <string_view>

#include <crisp/builtin.hpp>
#include <crisp/findings.hpp>
#include <crisp/pipeline.hpp>
#include <crisp/plugin_loader.hpp>
#include <crisp/runner.hpp>

namespace {

constexpr std::string_view kPipeline = R"(
crisp: 1
pipeline:
  - stage: grabber.capture
    with: {file: "${input}"}
  - stage: clock.convex_hull
  - stage: calibrate.rqe
  - stage: calibrate.refine
  - stage: diagnose.model
)";

void load_plugin(const char* file, crisp::Registrar& registrar) {
  crisp::PluginLoader loader(registrar);
  loader.load(file);
  for (const crisp::PluginRecord& plugin : loader.tried()) {
    if (!plugin.is_loaded()) throw crisp::Error(plugin.file.string() + ": " + plugin.refusal);
  }
}

/// @param plugin  whose terms are candidates, too; nullptr: none
/// @return whether the result can be trusted
bool diagnose(const char* capture, const char* plugin) {
  crisp::Builtin builtin;
  if (plugin != nullptr) load_plugin(plugin, builtin.registrar());
  crisp::RunSettings run;
  run.threads = 2;
  run.registrar = &builtin.registrar();
  auto loaded = crisp::load_pipeline(kPipeline, "diagnose_capture", {.input = capture}, run);

  std::shared_ptr<const crisp::Findings> found;
  crisp::RunHooks hooks;
  hooks.given = [&](const std::string&, const crisp::Item& item) {
    if (auto findings = item.as<crisp::Findings>()) found = std::move(findings);
  };
  const auto results = crisp::run_pipeline(loaded.pipeline, run, hooks);

  for (const crisp::Finding& finding : found->findings) {
    std::cout << finding.scope << ": " << finding.cause << (finding.accepted ? "" : " (rejected)");
    for (const crisp::Parameter& parameter : finding.parameters) {
      std::cout << ", " << parameter.name << " = " << parameter.value << " ± " << parameter.std_error << " "
                << parameter.unit;
    }
    std::cout << "\n";
  }
  std::cout << found->findings.size() << " findings\n";

  bool trusted = true;
  for (const crisp::NodeResult& result : results) {
    for (const std::string& caveat : result.report.caveats) {
      trusted = false;
      std::cerr << result.tag << ": untrusted: " << caveat << "\n";
    }
  }
  return trusted;
}

}  // namespace

int main(int count, char** words) {
  if (count != 2 && count != 3) {
    std::cerr << "usage: diagnose_capture HUB.pcap [PLUGIN.so]\n";
    return EXIT_FAILURE;
  }
  try {
    return diagnose(words[1], count == 3 ? words[2] : nullptr) ? EXIT_SUCCESS : EXIT_FAILURE;
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << "\n";
    return EXIT_FAILURE;
  }
}
