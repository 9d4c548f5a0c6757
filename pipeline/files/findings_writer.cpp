// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/files/findings_file.hpp"
#include "pipeline/files/json_text.hpp"

namespace crisp::files {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const std::vector<Gain>& gains) {
  Json all = Json::array();
  for (const Gain& gain : gains) {
    all.push_back({{"metric", gain.metric},
                   {"unit", gain.unit},
                   {"before", gain.before},
                   {"after", gain.after},
                   {"ci95", gain.ci95}});
  }
  return all;
}

Json json_of(const std::vector<Parameter>& parameters) {
  Json all = Json::array();
  for (const Parameter& p : parameters) {
    const double error = p.std_error > 0 ? p.std_error : kNotTested;  // nothing is known without an error
    all.push_back({{"name", p.name}, {"value", p.value}, {"unit", p.unit}, {"std_error", error}});
  }
  return all;
}

Json json_of(const std::vector<OtherCause>& causes) {
  Json all = Json::array();
  for (const OtherCause& other : causes) {
    all.push_back(
        {{"cause", other.cause}, {"scope", other.scope}, {"log10_bayes_factor", other.log10_bayes_factor}});
  }
  return all;
}

Json json_of(const std::vector<AcceptanceTest>& tests) {
  Json all = Json::array();
  for (const AcceptanceTest& test : tests) {
    all.push_back({{"name", test.name},
                   {"statistic", test.statistic},
                   {"threshold", test.threshold},
                   {"p_value", test.p_value},
                   {"passed", test.passed}});
  }
  return all;
}

Json json_of(const Finding& finding) {
  return {{"cause", finding.cause},
          {"scope", finding.scope},
          {"parameters", json_of(finding.parameters)},
          {"explained_fraction", finding.explained_fraction},
          {"log10_bayes_factor", finding.log10_bayes_factor},
          {"p_value", finding.p_value},
          {"confounded_with", finding.confounded_with},
          {"resolvable_by", finding.resolvable_by},
          {"alternatives", json_of(finding.alternatives)},
          {"gain", json_of(finding.gain)},
          {"tests", json_of(finding.tests)},
          {"accepted", finding.accepted},
          {"rejection_reason", finding.rejection_reason()}};
}

Json json_of(const UnnamedFinding& finding) {
  return {{"covariate", finding.covariate}, {"quantity", finding.quantity}, {"scope", finding.scope},
          {"amplitude", finding.amplitude}, {"unit", finding.unit},         {"p_value", finding.p_value},
          {"gain", json_of(finding.gain)},  {"accepted", finding.accepted}};
}

Json json_of(const ResidualDeparture& departure) {
  return {{"covariate", departure.covariate},
          {"quantity", departure.quantity},
          {"scope", departure.scope},
          {"amplitude", departure.amplitude},
          {"unit", departure.unit},
          {"p_value", departure.p_value},
          {"amplitude_after", departure.amplitude_after},
          {"p_value_after", departure.p_value_after}};
}

Json json_of(const Unobservable& unobservable) {
  return {{"cause", unobservable.parameter},
          {"reason", unobservable.reason},
          {"combination", unobservable.combination}};
}

Json json_of(const EstimatorArtifact& artifact) {
  return {
      {"artifact", artifact.name}, {"parameters", json_of(artifact.parameters)}, {"reason", artifact.reason}};
}

Json json_of(const DeviceFacts& facts) {
  return {{"device", facts.device},
          {"stamps", facts.stamps},
          {"skew", facts.skew},
          {"skew_std_error", facts.skew_std_error},
          {"delay_median", facts.delay_median},
          {"delay_95", facts.delay_95},
          {"period", facts.period},
          {"period_std_error", facts.period_std_error},
          {"nominal_period", facts.nominal_period},
          {"wander", facts.wander}};
}

Json json_of(const NoiseFacts& facts) {
  return {{"laser", facts.laser}, {"ranges", facts.ranges}, {"sigma", facts.sigma}};
}

template <class Things>
Json list_of(const Things& things) {
  Json all = Json::array();
  for (const auto& thing : things) all.push_back(json_of(thing));
  return all;
}

}  // namespace

std::string findings_json(const Findings& findings) {
  const Json all = {{"crisp", 1},
                    {"findings", list_of(findings.findings)},
                    {"unnamed", list_of(findings.unnamed)},
                    {"departures", list_of(findings.departures)},
                    {"unobservable", list_of(findings.unobservable)},
                    {"artifacts", list_of(findings.artifacts)},
                    {"devices", list_of(findings.devices)},
                    {"noise", list_of(findings.noise)},
                    {"gain", json_of(findings.gain)},
                    {"goodness_of_fit", {{"before_p", findings.before_p}, {"after_p", findings.after_p}}}};
  return json_text(all, 2) + "\n";
}

}  // namespace crisp::files
