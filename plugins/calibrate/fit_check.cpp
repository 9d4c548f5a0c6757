// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/fit_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "plugins/calibrate/rig_check.hpp"

namespace crisp::calibrate {
namespace {

using estimate::Refinement;

using Caveats = std::vector<std::string>;

void append(Caveats& to, Caveats more) { std::ranges::move(more, std::back_inserter(to)); }

Caveats of_misfit(const Refinement& refined, double noise) {
  const double misfit = misfit_of(refined, noise);
  const double relative = relative_misfit(refined, noise);
  if (relative <= kPoorFit) return {};
  return {fmt::format(
      "the beams' residuals against their surfaces are {:.1f} mm (RMS), {:.1f} times the ranges' noise ({:.1f} mm): the rig is slightly wrong, or the sensor model lacks an effect. Check the rig's mount and counts_per_revolution; `crisp diagnose` searches for the effect",
      misfit * 1e3, relative, misfit / relative * 1e3)};
}

Caveats of_rqe(const std::map<std::string, double>& quality, bool is_near_start) {
  constexpr double kLess = 0.05;  // [nat] that chance and the bias of an optimum of RQE do not explain
  const double after = quality.at("rqe_after");
  if (after > quality.at("rqe_before"))
    return {"the calibration increased the cloud's Rényi quadratic entropy: it is worse than its start"};
  const double less = after - quality.at("rqe_unrefined");
  if (!is_near_start || less <= kLess) return {};
  return {fmt::format(
      "the refinement increased the cloud's Rényi quadratic entropy by {:.3f} nat: it is worse than its start",
      less)};
}

}  // namespace

std::vector<std::string> check_silence(const Measurements& beams, const Rig& rig) {
  constexpr double kHalf = 0.5;
  struct Span {
    double first = std::numeric_limits<double>::infinity();
    double last = -std::numeric_limits<double>::infinity();
    double length() const { return std::max(0.0, last - first); }
  };
  Span all;
  std::vector<Span> of(rig.lasers.size());
  for (std::size_t i = 0; i < beams.size(); ++i) {
    for (Span* span : {&all, &of[beams.laser[i]]}) {
      span->first = std::min(span->first, beams.time[i]);
      span->last = std::max(span->last, beams.time[i]);
    }
  }
  Caveats caveats;
  for (std::size_t laser = 0; laser < of.size(); ++laser) {
    const std::string& name = rig.lasers[laser].name;
    if (of[laser].first > of[laser].last) {
      const bool is_device = !rig.lasers[laser].address.ip.empty() || !rig.lasers[laser].topic.empty();
      if (is_device)
        caveats.push_back(fmt::format(
            "there are no beams of {0}: its values are the rig's, and are not calibrated. Check its address, its cable and its power supply, and record again; or take {0} out of the rig",
            name));
      continue;
    }
    if (of[laser].length() >= kHalf * all.length()) continue;
    caveats.push_back(fmt::format(
        "{} was heard for {:.1f} s of {:.1f} s: its values rest on that part alone, and those of the others may refer to them. Check its cable and its power supply, and record again",
        name, of[laser].length(), all.length()));
  }
  return caveats;
}

double least_agreement(const Refinement& refined) {
  return std::ranges::min(refined.views, {}, &estimate::ViewConsistency::share).share;
}

bool agrees_well(const Refinement& refined) {
  return !refined.views.empty() && least_agreement(refined) > estimate::kConsistentShare;
}

double misfit_of(const Refinement& refined, double noise) { return std::sqrt(refined.chi2) * noise; }

double relative_misfit(const Refinement& refined, double noise) {
  return misfit_of(refined, noise) / (refined.scatter > 0 ? refined.scatter : noise);
}

std::vector<std::string> check_fit(const Refinement& refined, const Calibration& calibration,
                                   const Calibration& start, const Rig& rig, double noise) {
  Caveats caveats = refined.outcome.caveats;
  append(caveats, of_misfit(refined, noise));
  append(caveats, new_contradictions(calibration, start, rig));
  if (!agrees_well(refined)) append(caveats, of_rqe(calibration.quality, refined.restarts == 0));
  return caveats;
}

}  // namespace crisp::calibrate
