// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "pipeline/estimate/placed_beams.hpp"
#include "plugins/diagnose/dictionary.hpp"

namespace crisp {

/// What a model is judged by: the flat surfaces that its beams show, found without asking how well the views
/// of them agree.
class Evidence {
 public:
  /// @param sample  all beams, which the plate's readings cover; how they met their surfaces is filled in
  /// @param most    so many beams lie on surfels(), evenly chosen
  /// @param interrupted  asked while equations() works, from several threads, whether that is to end
  Evidence(const SensorModel& model, Sample sample, const SurfelSettings& settings, std::size_t most,
           std::function<bool()> interrupted = {});

  const Sample& sample() const { return sample_; }
  const Surfels& surfels() const { return surfels_; }  ///< with `most` beams
  BeamsView beams() const { return placed_.view(noise_); }
  Coverage coverage() const { return coverage_; }

  /// Near the model, in the dictionary's parameters; with what errors beams may share.
  ///
  /// @param most  so many beams are looked at, evenly chosen
  /// @throws Interrupted
  NormalEquations equations(const Dictionary& dictionary, std::size_t most) const;

 private:
  Sample sample_;
  PlacedBeams placed_;
  std::vector<float> noise_;  ///< of the beams, beside one another; none: alike
  SurfelSettings settings_;
  Surfels all_;      ///< with all beams
  Surfels surfels_;  ///< with `most` of them
  Coverage coverage_;
  std::vector<Division> shared_;
  std::function<bool()> interrupted_;
};

}  // namespace crisp
