// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/estimate/sample.hpp"
#include "pipeline/quality/surfels.hpp"

namespace crisp::estimate {

/// A division of beams into views of the same scene that a right calibration makes consistent.
struct ViewPartition {
  std::vector<std::string> views;      ///< in words: "laser1", "the fronts", "the first quarter"
  std::vector<std::uint32_t> of_beam;  ///< index into `views` of each beam
  std::string advice;                  ///< cause of inconsistent views, and what to do; "{}" is the suspect
  std::vector<std::size_t> groups =
      {};                   ///< of each view, which is compared with others of its group; or empty
  bool is_by_time = false;  ///< whether views differ in time alone: a wrong mount affects all alike
};

/// The partitions that show a wrong calibration: by laser (if there are several), which a wrong λ, τ or α
/// parts; by half of the sweep, which a wrong mount, mirror or eccentric encoder parts; by quarter of each
/// recording, which an encoder that slips or drifts parts; and each laser's beams by the plate's rate (if it
/// varies), which a wrong η parts that a wrong λ makes up for at the usual rate.
///
/// @param names  of the lasers, in the order of their numbers
std::vector<ViewPartition> view_partitions(const Sample& sample, const std::vector<std::string>& names);

/// Errors about the spin axis show on upright surfaces alone.
enum class Orientation : std::uint8_t { upright, level };

/// Expected differences between views under a right calibration, as standard deviations.
struct ViewErrors {
  double range = 0;  ///< [m] of a range
  double angle = 0;  ///< [rad] of the plate at a beam's time: steps of its encoder, errors of the clocks
};

/// Share of a view's beams from which it agrees with another. In 35 drawn recordings of rooms, halls and
/// streets the least share of a right calibration was 0.81 to 0.99.
inline constexpr double kConsistentShare = 0.7;

/// Fraction of flat surfaces on which two views agree.
struct ViewConsistency {
  std::string view;
  std::string other;
  Orientation orientation = Orientation::upright;  ///< of the surfaces
  double beams = 0;                                ///< of `view` on them, where beams of `other` go as well
  double share = 0;         ///< of these, on surfaces that `other` meets within 3 standard deviations
  bool is_by_time = false;  ///< the partition's
};

/// All ordered pairs of a partition's views that have beams on such surfaces in the same directions, in the
/// order of the views. Pairs with few such beams are left out.
std::vector<ViewConsistency> view_consistency(const quality::Surfels& surfels,
                                              const quality::BeamsView& beams, const ViewPartition& partition,
                                              const ViewErrors& errors);

/// "walls" or "floors and ceilings".
const char* in_words(Orientation orientation);

/// The least consistent pair of a partition's views, as a caveat, if it is below kConsistentShare.
std::optional<std::string> inconsistency(const ViewPartition& partition,
                                         const std::vector<ViewConsistency>& pairs);

}  // namespace crisp::estimate
