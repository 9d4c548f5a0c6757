// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numbers>
#include <string>
#include <vector>

#include "pipeline/data/degree.hpp"
#include "plugins/study/parallel_runs.hpp"
#include "plugins/study/study_part.hpp"
#include "plugins/study/trial.hpp"

namespace crisp {

/// Where calibrations may start.
struct StartRange {
  double tau_least = 0;         ///< [m]
  double tau_most = 0.5;        ///< [m]
  double alpha = 20 * kDegree;  ///< [rad] to either side of the truth
  double lambda =
      std::numbers::pi;  ///< [rad] to either side of the truth; of the first laser it is the gauge
  double eta = 0.1;      ///< [s] to either side of the truth
};

struct BasinSettings {
  TrialSettings trial;  ///< scene, beams, rig and truth; where it starts and what estimates does not count
  StartRange range;
  std::size_t starts = 1000;
  std::size_t starts_a_recording = 20;  ///< then a new one is simulated
  double same = 3;               ///< [standard errors] ends that are no farther from one another are the same
  std::uint64_t first_seed = 1;  ///< of the first recording
  Shard part;                    ///< which recordings are explored
  unsigned threads = 1;

  /// How many recordings there are for all starts.
  std::size_t recordings() const { return (starts + starts_a_recording - 1) / starts_a_recording; }
};

/// How a calibration ended, against the optimum at the truth: calibrate.refine alone, from the truth on.
enum class Ending {
  kSame,     ///< in the same optimum
  kDoubted,  ///< elsewhere, and it said that it is not sure, or gave no result
  kSilent,   ///< elsewhere, and it was sure: what must not be
};

/// One calibration from a start drawn at random.
struct BasinStart {
  std::uint64_t recording = 0;  ///< its seed
  std::vector<double> start;    ///< values of the free parameters [SI]
  Ending ending = Ending::kSame;
  double off = 0;                   ///< [standard errors] of the parameter that ended farthest off
  std::string farthest;             ///< that parameter
  double error = 0;                 ///< [SI] by how much it is off
  std::vector<std::string> doubts;  ///< what the calibration said
};

/// The starts of one recording.
struct BasinRecording {
  std::uint64_t seed = 0;
  std::vector<std::string> parameters;  ///< those that are calibrated
  std::vector<BasinStart> starts;
  std::vector<std::string> doubts;  ///< of the refinement that started at the truth
  std::string failure;  ///< why the refinement fails even from the truth; there are no starts then
};

/// Calibrates recordings from starts all over the range: calibrate.rqe, then calibrate.refine. What a
/// recording gives depends on its seed alone.
std::vector<BasinRecording> explore_basin(const BasinSettings& settings, const MakeMeasure& make_measure,
                                          const StudyHooks& hooks = {});

}  // namespace crisp
