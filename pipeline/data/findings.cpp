// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/data/findings.hpp"

#include <cmath>

#include "pipeline/data/least_chance.hpp"

namespace crisp {
namespace {

/// That the less of two independent p-values is as small as this one; what was not asked does not count.
double less_sure(double one, double other) {
  const double least = std::fmin(one, other);
  return std::isnan(one) || std::isnan(other) ? least : least_of(2, least);
}

}  // namespace

std::string Finding::refusal() const {
  if (accepted) return {};
  return refused.empty() ? "it does not pay on data that it was not fitted to" : refused;
}

void Findings::append(const Findings& other) {
  const auto add = [](auto& all, const auto& more) { all.insert(all.end(), more.begin(), more.end()); };
  add(findings, other.findings);
  add(unnamed, other.unnamed);
  add(departures, other.departures);
  add(unobservable, other.unobservable);
  add(artefacts, other.artefacts);
  add(devices, other.devices);
  add(noise, other.noise);
  add(gain, other.gain);
  before_p = less_sure(before_p, other.before_p);
  after_p = less_sure(after_p, other.after_p);
}

}  // namespace crisp
