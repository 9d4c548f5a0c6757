// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numbers>
#include <string>
#include <vector>

#include "pipeline/data/degree.hpp"
#include "plugins/study/monte_carlo_trial.hpp"
#include "plugins/study/parallel_runs.hpp"
#include "plugins/study/study_part.hpp"

namespace crisp::study {

/// Range of a calibration's starts.
struct StartRange {
  double min_tau = 0;                 ///< [m]
  double max_tau = 0.5;               ///< [m]
  double alpha = 20 * data::kDegree;  ///< [rad] to either side of the truth
  double lambda =
      std::numbers::pi;  ///< [rad] to either side of the truth; of the first laser it is the gauge
  double eta = 0.1;      ///< [s] to either side of the truth
};

struct BasinSettings {
  TrialSettings trial;  ///< scene, beams, rig and truth; where it starts and what estimates does not count
  StartRange range;
  std::size_t starts = 1000;
  std::size_t starts_per_recording = 20;  ///< then a new one is simulated
  double same = 3;               ///< [standard errors] ends that are no farther from one another are the same
  std::uint64_t first_seed = 1;  ///< of the first recording
  batch::Shard part;             ///< which recordings are explored
  unsigned threads = 1;

  /// Number of recordings for all starts.
  std::size_t recordings() const { return (starts + starts_per_recording - 1) / starts_per_recording; }
};

/// End of a calibration, compared with the optimum at the truth: calibrate.refine alone, from the truth on.
enum class Ending {
  kSame,         ///< in the same optimum
  kWithCaveats,  ///< elsewhere, with a caveat, or without a result
  kSilent,       ///< elsewhere, without caveats: a failure
};

/// One calibration from a start drawn at random.
struct BasinStart {
  std::uint64_t recording = 0;  ///< its seed
  std::vector<double> start;    ///< values of the free parameters [SI]
  Ending ending = Ending::kSame;
  double off = 0;                    ///< [standard errors] of the parameter that ended farthest off
  std::string farthest;              ///< that parameter
  double error = 0;                  ///< [SI] by how much it is off
  std::vector<std::string> caveats;  ///< of the calibration
};

/// The starts of one recording.
struct BasinRecording {
  std::uint64_t seed = 0;
  std::vector<std::string> parameters;  ///< those that are calibrated
  std::vector<BasinStart> starts;
  std::vector<std::string> caveats;  ///< of the refinement that started at the truth
  std::string failure;  ///< why the refinement fails even from the truth; there are no starts then
};

/// Calibrates recordings from starts all over the range: calibrate.rqe, then calibrate.refine. What a
/// recording gives depends on its seed alone.
std::vector<BasinRecording> explore_basin(const BasinSettings& settings, const MakeMeasure& make_measure,
                                          const StudyHooks& hooks = {});

}  // namespace crisp::study
