// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/report/findings_inspector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pipeline/data/goodness_of_fit_tests.hpp"
#include "pipeline/files/findings_file.hpp"
#include "pipeline/files/json_text.hpp"
#include "plugins/diagnose/report/findings_report.hpp"

namespace crisp::diagnose {
namespace {

Inspection inspect_findings(const std::filesystem::path& file, const Rig&) {
  const Findings all = files::read_findings(file);
  Inspection inspection;
  inspection.data = {{"findings", nlohmann::json::array()},
                     {"unnamed", all.unnamed.size()},
                     {"unobservable", all.unobservable.size()},
                     {"artifacts", all.artifacts.size()},
                     {"devices", all.devices.size()}};
  const auto accepted = std::ranges::count_if(all.findings, &Finding::accepted);
  inspection.text = fmt::format(
      "  causes: {}, and {} rejected; unnamed findings: {}; causes unobservable in these data: {}", accepted,
      std::ranges::ssize(all.findings) - accepted, all.unnamed.size(), all.unobservable.size());
  for (const Finding& finding : all.findings) {
    inspection.text += "\n  " + headline(finding);
    inspection.data["findings"].push_back(
        {{"cause", finding.cause}, {"scope", finding.scope}, {"accepted", finding.accepted}});
  }
  for (const UnnamedFinding& finding : all.unnamed) inspection.text += "\n  " + headline(finding);
  for (const Unobservable& one : all.unobservable) {
    inspection.text += fmt::format("\n  not identifiable: {}: {}", one.parameter, one.reason);
    if (!one.combination.empty()) inspection.text += "; identifiable is " + one.combination;
  }
  for (const EstimatorArtifact& artifact : all.artifacts) {
    inspection.text += fmt::format("\n  estimator artifact: {}", artifact.name);
  }
  for (const DeviceFacts& facts : all.devices) {
    if (std::isnan(facts.skew)) {
      inspection.text +=
          fmt::format("\n  {}: clock not identifiable from {} stamps", facts.device, facts.stamps);
      continue;
    }
    inspection.text += fmt::format(
        "\n  {}: {} stamps, skew {:+.2f} ± {:.2f} ppm, delays of {:.3f} ms (median)", facts.device,
        facts.stamps, 1e6 * facts.skew, 1e6 * facts.skew_std_error, 1e3 * facts.delay_median);
  }
  for (const NoiseFacts& facts : all.noise) {
    inspection.text +=
        fmt::format("\n  {}: {} ranges, noise {:.2f} mm", facts.laser, facts.ranges, 1e3 * facts.sigma);
  }
  if (!std::isnan(all.before_p)) {
    inspection.text += "\n  " + data::fit_statistics_text(all);
    inspection.data["before_p"] = all.before_p;
    inspection.data["after_p"] = all.after_p;
  }
  return inspection;
}

/// Recognizes the first keys that findings_json() writes.
bool is_findings(std::string_view head) {
  constexpr std::string_view kBegin = R"({"crisp":1,"findings":[)";
  return files::without_space(head.substr(0, 2 * kBegin.size())).starts_with(kBegin);
}

}  // namespace

Inspector findings_inspector() { return {"a diagnosis", is_findings, inspect_findings}; }

}  // namespace crisp::diagnose
