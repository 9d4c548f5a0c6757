// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include <crisp/findings.hpp>

#include "pipeline/statistics/multiple_testing.hpp"

namespace crisp {
namespace {

/// Šidák-corrected p-value of the smaller of two independent p-values; a missing one does not count.
double combined_p_value(double one, double other) {
  const double least = std::fmin(one, other);
  return std::isnan(one) || std::isnan(other) ? least : statistics::sidak_p_value(2, least);
}

}  // namespace

std::string Finding::rejection_reason() const {
  if (accepted) return {};
  return rejection.empty() ? "it does not improve the fit on held-out data (cross-validation)" : rejection;
}

void Findings::append(const Findings& other) {
  const auto add = [](auto& all, const auto& more) { all.insert(all.end(), more.begin(), more.end()); };
  add(findings, other.findings);
  add(unnamed, other.unnamed);
  add(departures, other.departures);
  add(unobservable, other.unobservable);
  add(artifacts, other.artifacts);
  add(devices, other.devices);
  add(noise, other.noise);
  add(gain, other.gain);
  before_p = combined_p_value(before_p, other.before_p);
  after_p = combined_p_value(after_p, other.after_p);
}

}  // namespace crisp
