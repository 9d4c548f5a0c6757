// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/noise_errors.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "pipeline/model/catalogue.hpp"
#include "pipeline/quality/blocks.hpp"

namespace crisp {
namespace {

constexpr std::uint32_t kParts = 20;  // of fewer the scatter is too roughly known for three standard errors
constexpr double kSettled = 1e-4;     // [nat] far below what a part that is left out changes

/// For each range which part it is of: what stands together is strewn over all parts.
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

/// The law without each part of the ranges.
std::vector<LawInParts::Without> without_each(const std::vector<std::uint32_t>& parts, const NoiseLaw& law,
                                              const RangeErrors& errors) {
  if (parts.empty() || std::ranges::max(parts) == 0) return {};
  std::vector<LawInParts::Without> without(std::ranges::max(parts) + std::size_t{1});
  for_each_index(without.size(), [&](std::size_t part) {
    RangeErrors rest = select(errors, [&](std::size_t i) { return parts[i] != part; });
    rest.centre_beams();
    const auto left = static_cast<double>(rest.size());
    without[part] = {.share = 1 - left / static_cast<double>(errors.size()),
                     .law = fitted(law, rest, kSettled)};
  });
  return without;
}

/// What parts of different sizes say of a parameter.
struct Told {
  double value = 0;  // less its bias
  double std_error = 0;
};

/// The jackknife of parts that need not be alike: Busing, Meijer and van der Leeden, Statistics and Computing
/// 9 (1999), 3.
Told jackknife(double all, const std::vector<double>& shares, const std::vector<double>& without) {
  Told told{.value = all};
  if (shares.empty()) return told;
  const auto parts = static_cast<double>(shares.size());
  for (std::size_t j = 0; j < shares.size(); ++j) told.value += (1 - shares[j]) * (all - without[j]);
  double squares = 0;
  for (std::size_t j = 0; j < shares.size(); ++j) {
    const double times = 1 / shares[j];
    const double by_itself = times * all - (times - 1) * without[j];
    squares += std::pow(by_itself - told.value, 2) / (times - 1);
  }
  told.std_error = std::sqrt(squares / parts);
  return told;
}

/// The nearest value that the catalogue lets the parameter of an effect have: what a fit is off by, taken
/// off, may lead beyond.
double within_bounds(const std::string& cause, const Parameter& parameter) {
  const auto effect = std::ranges::find(effects_beyond_the_chain(), cause, &EffectInfo::name);
  if (effect == effects_beyond_the_chain().end()) return parameter.value;
  const auto bounds = std::ranges::find(effect->parameters, parameter.name, &EffectParameter::name);
  if (bounds == effect->parameters.end() || !(bounds->lower < bounds->upper)) return parameter.value;
  return std::clamp(parameter.value, bounds->lower, bounds->upper);
}

}  // namespace

LawInParts in_parts(const NoiseLaw& law, const RangeErrors& errors) {
  RangeErrors centred = errors;  // some of all that were once
  centred.centre_beams();
  LawInParts fits{.law = fitted(law, centred, kSettled), .errors = {}, .times = {}, .places = {}};
  fits.times = without_each(parts_of(centred.block), fits.law, centred);
  fits.places = without_each(parts_of(centred.place), fits.law, centred);
  fits.errors = std::move(centred);
  return fits;
}

std::vector<Parameter> parameters_of(const NoiseWay& way, const LawInParts& fits) {
  std::vector<Parameter> found = way.parameters(fits.law);
  for (std::size_t k = 0; k < found.size(); ++k) {
    const double all = found[k].value;
    const auto told_by = [&](const std::vector<LawInParts::Without>& parts) {
      std::vector<double> shares;
      std::vector<double> values;
      for (const auto& [share, law] : parts) {
        shares.push_back(share);
        values.push_back(way.parameters(law)[k].value);
      }
      return jackknife(all, shares, values);
    };
    const Told over_time = told_by(fits.times);
    found[k].value = over_time.value;
    found[k].std_error = std::max(over_time.std_error, told_by(fits.places).std_error);
  }
  if (way.told_by_ranges)
    std::ranges::move(way.told_by_ranges(fits.law, fits.errors), std::back_inserter(found));
  for (Parameter& parameter : found) {
    parameter.value = within_bounds(way.cause, parameter);
    parameter.free = true;
  }
  return found;
}

}  // namespace crisp
