// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/single_beam_refusal.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>
#include <limits>

#include <crisp/error.hpp>

#include "pipeline/data/degree.hpp"

namespace crisp::calibrate {
namespace {

/// The mirror angles of one laser's beams [rad].
struct MirrorAngles {
  float least = std::numeric_limits<float>::infinity();
  float most = -std::numeric_limits<float>::infinity();
  std::uint64_t beams = 0;
};

std::vector<MirrorAngles> mirror_angles(const Measurements& beams, std::size_t lasers) {
  std::vector<MirrorAngles> angles(lasers);
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (beams.laser[i] >= lasers) continue;
    MirrorAngles& own = angles[beams.laser[i]];
    own.least = std::min(own.least, beams.mirror_angle[i]);
    own.most = std::max(own.most, beams.mirror_angle[i]);
    ++own.beams;
  }
  return angles;
}

}  // namespace

void refuse_single_beams(const Measurements& beams, const Calibration& lasers,
                         const std::vector<std::string>& fixed) {
  constexpr float kSame = 1e-5F;  // [rad] what rounding leaves
  const auto is_fixed = [&](const std::string& name) {
    return std::ranges::find(fixed, name) != fixed.end();
  };
  if (is_fixed("alpha")) return;
  const auto angles = mirror_angles(beams, lasers.lasers.size());
  std::vector<std::string> found;
  for (std::size_t k = 0; k < angles.size(); ++k) {
    const MirrorAngles& own = angles[k];
    if (own.beams == 0 || own.most - own.least > kSame || is_fixed(lasers.lasers[k].name + ".alpha"))
      continue;
    found.push_back(fmt::format("{} ({} beams at {:.3f} deg)", lasers.lasers[k].name, own.beams,
                                static_cast<double>(own.least) / data::kDegree));
  }
  if (found.empty()) return;
  throw Error(
      fmt::format(
          "all beams of {} have the same mirror angle: its alpha, lambda and tau are not identifiable separately",
          fmt::join(found, ", ")),
      "record whole scans (the laser's output range), or hold them: fixed: [alpha, tau]");
}

}  // namespace crisp::calibrate
