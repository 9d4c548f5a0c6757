// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/found_effects.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <crisp/error.hpp>

namespace crisp::simulate {
namespace {

/// Something that was found of one device, before it is known whether it can be simulated.
struct Found {
  std::string where;  // in the file: "findings[2]"
  std::string cause;
  std::string scope;
  std::vector<Parameter> parameters;
};

/// Weibull distribution of delays with this median and 95th percentile [s]; exponential where no Weibull
/// distribution has them.
std::vector<Parameter> delay_distribution(double median, double high) {
  constexpr double kMin = 0.2, kMax = 5;
  const double in_20 = std::log(20.0);  // −ln of the share that is later than the percentile
  const double in_2 = std::numbers::ln2;
  const double ratio = median > 0 ? high / median : 0;
  const double shape = ratio > 1 ? std::clamp(std::log(in_20 / in_2) / std::log(ratio), kMin, kMax) : 1;
  const double mean = median * std::pow(in_2, -1 / shape) * std::tgamma(1 + 1 / shape);
  return {{.name = "mean", .unit = "s", .value = mean}, {.name = "shape", .unit = "1", .value = shape}};
}

void add_clocks_and_links(const Findings& findings, std::vector<Found>& all) {
  for (std::size_t i = 0; i < findings.devices.size(); ++i) {
    const DeviceFacts& facts = findings.devices[i];
    const std::string where = fmt::format("devices[{}]", i);
    all.push_back({where, "clock.drift", facts.device, {{.name = "skew", .unit = "1", .value = facts.skew}}});
    all.push_back(
        {where, "latency.jitter", facts.device, delay_distribution(facts.delay_median, facts.delay_95)});
  }
}

void add_mirrors(const Findings& findings, std::vector<Found>& all) {
  for (std::size_t i = 0; i < findings.devices.size(); ++i) {
    const DeviceFacts& facts = findings.devices[i];
    if (!(facts.period > 0 && facts.nominal_period > 0)) continue;
    // The period is measured by the laser's own clock.
    const double excess = facts.period * (1 + facts.skew) - facts.nominal_period;
    const std::string where = fmt::format("devices[{}]", i);
    all.push_back({where, "mirror.period", facts.device, {{.name = "excess", .unit = "s", .value = excess}}});
    all.push_back(
        {where, "mirror.wander", facts.device, {{.name = "rms", .unit = "1", .value = facts.wander}}});
  }
}

std::vector<Found> all_found(const Findings& findings) {
  std::vector<Found> all;
  add_clocks_and_links(findings, all);
  for (std::size_t i = 0; i < findings.noise.size(); ++i) {
    const NoiseFacts& facts = findings.noise[i];
    all.push_back({fmt::format("noise[{}]", i),
                   "noise.normal",
                   facts.laser,
                   {{.name = "sigma", .unit = "m", .value = facts.sigma}}});
  }
  for (std::size_t i = 0; i < findings.findings.size(); ++i) {
    const Finding& finding = findings.findings[i];
    if (!finding.accepted) continue;
    all.push_back({fmt::format("findings[{}]", i), finding.cause, finding.scope, finding.parameters});
  }
  add_mirrors(findings, all);  // above a finding of the same, which does not know the laser's clock
  return all;
}

void check_device(const Found& found, const std::string& file, const Rig& rig) {
  if (found.scope == "plate" || found.scope == rig.plate.name) return;
  std::vector<std::string> names;
  for (const auto& laser : rig.lasers) names.push_back(laser.name);
  if (std::ranges::find(names, found.scope) != names.end()) return;
  throw Error(
      fmt::format("{}: {} is of '{}', which the rig does not have", found.where, found.cause, found.scope),
      fmt::format("it has {} and {}: give --rig the diagnosed rig", fmt::join(names, ", "), rig.plate.name),
      {file});
}

bool has_parameter(const EffectInfo& info, const Parameter& parameter) {
  return std::ranges::find(info.parameters, parameter.name, &EffectParameter::name) != info.parameters.end();
}

/// Whether a finding has the parameters of a cause's general member, a curve, in place of its formula's.
bool is_curve(const Found& found, const EffectInfo& info, const std::vector<EffectInfo>& catalogue) {
  const auto is_of_a_shape = [&](const Parameter& parameter) {
    return std::ranges::any_of(catalogue, [&](const EffectInfo& other) {
      return other.name.starts_with("empirical.") && has_parameter(other, parameter);
    });
  };
  return std::ranges::any_of(found.parameters, [&](const Parameter& parameter) {
    return !has_parameter(info, parameter) && is_of_a_shape(parameter);
  });
}

/// Why the file does not determine what is to be simulated.
std::optional<std::string> missing(const Found& found, const EffectInfo* info,
                                   const std::vector<EffectInfo>& catalogue) {
  if (std::ranges::any_of(found.parameters, [](const auto& p) { return std::isnan(p.value); }))
    return ", which the file does not hold";
  if (found.cause == "noise.mixed_pixels")
    return ": the file holds the fraction of edges, not the width of the spot";
  if (found.cause == "clock.drift" && std::ranges::count(found.parameters, "rms", &Parameter::name) > 0)
    return ": the file holds the size of a drift that varies, not its course";
  if (info && is_curve(found, *info, catalogue)) return ": a curve, which calibration.yaml has as a term";
  return std::nullopt;
}

/// As `effects` would have it.
OptionGroup as_option(const Found& found, const std::string& file) {
  OptionGroup group{.name = found.scope + "." + found.cause, .entries = {}, .place = {file}};
  for (const Parameter& parameter : found.parameters) {
    const std::string unit = parameter.unit == "1" ? "" : " " + parameter.unit;
    group.entries.push_back(
        {.name = parameter.name, .value = fmt::format("{}{}", parameter.value, unit), .place = {file}});
  }
  return group;
}

}  // namespace

FoundEffects effects_of(const Findings& findings, const std::string& file, const Rig& rig,
                        const std::vector<EffectInfo>& catalogue) {
  FoundEffects result;
  OptionGroups requested;
  for (const Found& found : all_found(findings)) {
    const auto info = std::ranges::find(catalogue, found.cause, &EffectInfo::name);
    if (info == catalogue.end() || info->scope != Scope::kScene) check_device(found, file, rig);
    const EffectInfo* known = info == catalogue.end() ? nullptr : &*info;
    if (const auto reason = missing(found, known, catalogue)) {
      result.others.push_back(fmt::format("{} of {}{}", found.cause, found.scope, *reason));
    } else if (known && known->scope != Scope::kScene) {
      requested.push_back(as_option(found, file));
    } else {
      result.others.push_back(fmt::format("{} of {}", found.cause, found.scope));
    }
  }
  for (const UnnamedFinding& finding : findings.unnamed) {
    if (!finding.accepted) continue;
    result.others.push_back(
        fmt::format("{} of {} over the {}, unnamed: the file holds its amplitude, not its shape",
                    finding.quantity, finding.scope, finding.covariate));
  }
  result.effects = read_effects(requested, rig, catalogue);
  for (Effect& effect : result.effects) effect.measured = true;
  return result;
}

}  // namespace crisp::simulate
