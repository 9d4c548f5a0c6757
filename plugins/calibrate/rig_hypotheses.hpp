// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <crisp/measure.hpp>
#include <crisp/rig.hpp>

#include "pipeline/estimate/scene_repeat.hpp"
#include "pipeline/estimate/surfel_refinement.hpp"
#include "plugins/calibrate/rig_change.hpp"
#include "plugins/calibrate/rqe_calibration.hpp"

namespace crisp::calibrate {

/// Share of the beams that lie on flat surfaces in rooms, halls and streets at least (0.89 to 0.99 in nearly
/// all).
inline constexpr double kOrdinaryShare = 0.65;

/// Settings for calibrating again under another assumption on the rig.
struct HypothesisSettings {
  const TermRegistry* terms = nullptr;
  Measure* measure = nullptr;
  estimate::RefinementSettings refinement;
  std::function<bool()> interrupted = [] { return false; };
  Reporter report;
};

/// Mounts that are off by little, as caveats: where `mount.mirror_zero` is clearly not 0 once it is free.
///
/// @param model  a refined one; lasers whose mount it estimates are left out
std::vector<std::string> check_mounts(const SensorModel& model, const estimate::Sample& sample,
                                      const Rig& rig, const HypothesisSettings& settings);

/// Search for the mistake in the rig that explains why a calibration does not fit.
///
/// Calibrates again with a share of the beams for each possible change of the rig. A change counts if the
/// calibration with it has no caveat, agrees with the nominal values, and has more beams on flat surfaces
/// than that of the rig as it stands.
class RigErrorSearch {
 public:
  RigErrorSearch(const estimate::Sample& sample, const Rig& rig, HypothesisSettings settings);

  /// Wrong counts a revolution, as a caveat: the scene repeats clearly better after another angle of the
  /// plate, or a little better, and with such counts a calibration fits with clearly more beams.
  std::optional<std::string> counts();

  /// Counts that are off by a factor of two or four, as a caveat, where the plate turned too little for
  /// counts().
  std::optional<std::string> factor_of_counts();

  /// Any other mistake, as a caveat: the encoder's direction, mounts, lasers that are upside down, two that
  /// are exchanged, or counts that are off by a factor of two or four where the plate turned too little to
  /// show it.
  ///
  /// Takes some calibrations' time.
  std::optional<std::string> any();

 private:
  /// How well the data fit with a change.
  struct Fit {
    bool fits = false;                ///< without a caveat, and in agreement with the nominal values
    double beams = 0;                 ///< on flat surfaces: a wrong rig may fold the scene onto a few of them
    double all_beams = 0;             ///< of the sample
    std::string mistake;              ///< the mistake in the nominal values that it shows, as a caveat
    std::vector<std::string> mounts;  ///< of unchanged lasers that are off by little, in words

    /// Whether no other fit can explain clearly more.
    bool explains_all() const;
    /// Whether it fits, with more beams on flat surfaces; if the other fits as well, clearly more, and as
    /// many as in ordinary scenes.
    bool explains_more_than(const Fit& other) const;
  };

  Fit fit_with(const RigChange& change, const estimate::Sample& sample) const;
  const Fit& fit_of_rig();
  /// The fit with a change, if it explains more than that without.
  std::optional<Fit> better_fit(const RigChange& change, const estimate::Sample& sample,
                                const Fit& unchanged);
  /// The first change with which all data fit, and those like it.
  std::vector<RigChange> those_that_fit(const std::vector<RigChange>& changes);
  /// Changes of the plate.
  std::vector<RigChange> of_plate();
  /// Changes of a laser with which its own beams fit, if they do not with the rig.
  std::vector<RigChange> of_one(std::size_t laser);
  /// Changes of the lasers whose own beams do not fit, with which all fit together.
  std::vector<RigChange> of_some();
  /// Changes of the lasers that only all together show.
  std::vector<RigChange> of_all();

  estimate::Sample sample_;
  const Rig& rig_;
  HypothesisSettings settings_;
  std::optional<estimate::SceneRepeat> period_;
  std::optional<Fit> fit_of_rig_;
  std::size_t step_ = 0;  ///< of any()
};

}  // namespace crisp::calibrate
