// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/data/findings.hpp"

#include <cmath>

namespace crisp {

void Findings::append(const Findings& other) {
  const auto add = [](auto& all, const auto& more) { all.insert(all.end(), more.begin(), more.end()); };
  add(findings, other.findings);
  add(unnamed, other.unnamed);
  add(departures, other.departures);
  add(unobservable, other.unobservable);
  add(artefacts, other.artefacts);
  add(devices, other.devices);
  add(noise, other.noise);
  before_p = std::fmin(before_p, other.before_p);  // the one that was asked for
  after_p = std::fmin(after_p, other.after_p);
}

}  // namespace crisp
