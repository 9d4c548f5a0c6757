// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/noise/jackknife.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include <crisp/effect_catalogue.hpp>

#include "pipeline/quality/blocks.hpp"

namespace crisp::diagnose {
namespace {

constexpr std::uint32_t kParts = 20;  // with fewer, the standard error is too uncertain for a 3 σ test
constexpr double kSettled = 1e-4;     // [nat] far below the effect of leaving out a group

/// Group of each range; ranges of the same index (block or place) share a group, and neighbouring indices do
/// not.
std::vector<std::uint32_t> parts_of(const std::vector<std::uint32_t>& together) {
  std::map<std::uint32_t, std::uint32_t> part;
  for (const std::uint32_t one : together) part.try_emplace(one, 0);
  std::uint32_t next = 0;
  for (auto& [one, own] : part) own = next++ % kParts;
  std::vector<std::uint32_t> parts;
  parts.reserve(together.size());
  for (const std::uint32_t one : together) parts.push_back(part.at(one));
  return parts;
}

/// The noise model fitted without each group.
std::vector<JackknifedModel::Without> without_each(const std::vector<std::uint32_t>& parts,
                                                   const NoiseModel& model, const RangeErrors& errors) {
  if (parts.empty() || std::ranges::max(parts) == 0) return {};
  std::vector<JackknifedModel::Without> without(std::ranges::max(parts) + std::size_t{1});
  quality::for_each_index(without.size(), [&](std::size_t part) {
    RangeErrors rest = select(errors, [&](std::size_t i) { return parts[i] != part; });
    rest.centre_beams();
    const auto left = static_cast<double>(rest.size());
    without[part] = {.share = 1 - left / static_cast<double>(errors.size()),
                     .model = fitted(model, rest, kSettled)};
  });
  return without;
}

/// Jackknife estimate of a parameter.
struct Reported {
  double value = 0;  // bias-corrected
  double std_error = 0;
};

/// Delete-a-group jackknife for groups of unequal size (Busing, Meijer and van der Leeden, Statistics and
/// Computing 9, 1999, 3).
Reported jackknife(double all, const std::vector<double>& shares, const std::vector<double>& without) {
  Reported reported{.value = all};
  if (shares.empty()) return reported;
  const auto parts = static_cast<double>(shares.size());
  for (std::size_t j = 0; j < shares.size(); ++j) reported.value += (1 - shares[j]) * (all - without[j]);
  double squares = 0;
  for (std::size_t j = 0; j < shares.size(); ++j) {
    const double times = 1 / shares[j];
    const double by_itself = times * all - (times - 1) * without[j];
    squares += std::pow(by_itself - reported.value, 2) / (times - 1);
  }
  reported.std_error = std::sqrt(squares / parts);
  return reported;
}

/// Clamps a parameter to its bounds in the catalogue, which the bias correction may exceed.
double within_bounds(const std::string& cause, const Parameter& parameter) {
  const auto effect = std::ranges::find(effects_beyond_the_chain(), cause, &EffectInfo::name);
  if (effect == effects_beyond_the_chain().end()) return parameter.value;
  const auto bounds = std::ranges::find(effect->parameters, parameter.name, &EffectParameter::name);
  if (bounds == effect->parameters.end() || !(bounds->lower < bounds->upper)) return parameter.value;
  return std::clamp(parameter.value, bounds->lower, bounds->upper);
}

}  // namespace

JackknifedModel in_parts(const NoiseModel& model, const RangeErrors& errors) {
  RangeErrors centred = errors;  // the input may be a subset whose means differ
  centred.centre_beams();
  JackknifedModel fits{.model = fitted(model, centred, kSettled), .errors = {}, .times = {}, .places = {}};
  fits.times = without_each(parts_of(centred.block), fits.model, centred);
  fits.places = without_each(parts_of(centred.place), fits.model, centred);
  fits.errors = std::move(centred);
  return fits;
}

std::vector<Parameter> parameters_of(const NoiseComponent& component, const JackknifedModel& fits) {
  std::vector<Parameter> found = component.parameters(fits.model);
  for (std::size_t k = 0; k < found.size(); ++k) {
    const double all = found[k].value;
    const auto resolvable_by = [&](const std::vector<JackknifedModel::Without>& parts) {
      std::vector<double> shares;
      std::vector<double> values;
      for (const auto& [share, model] : parts) {
        shares.push_back(share);
        values.push_back(component.parameters(model)[k].value);
      }
      return jackknife(all, shares, values);
    };
    const Reported over_time = resolvable_by(fits.times);
    found[k].value = over_time.value;
    found[k].std_error = std::max(over_time.std_error, resolvable_by(fits.places).std_error);
  }
  if (component.determined_by_ranges)
    std::ranges::move(component.determined_by_ranges(fits.model, fits.errors), std::back_inserter(found));
  for (Parameter& parameter : found) {
    parameter.value = within_bounds(component.cause, parameter);
    parameter.free = true;
  }
  return found;
}

}  // namespace crisp::diagnose
