// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/data/findings.hpp"
#include "pipeline/estimate/sample.hpp"
#include "pipeline/quality/surfels.hpp"

namespace crisp {

/// Every other turn of the plate, or every other recording: what a model is fitted to, and what it is then
/// judged by.
struct Halves {
  Sample fitted;
  Sample held_out;
  std::vector<std::uint32_t> turn;  ///< of each held-out beam, from 0
};

/// Splits by recordings where there are several, and else by turns of the plate; where there are fewer than
/// four, by eighths of the recording.
Halves halves_of(const Sample& sample);

/// How well models place beams that they were not fitted to. Which beams count, and on which surfaces they
/// lie, is chosen once, with a model that has none of what is to be judged.
class HeldOut {
 public:
  HeldOut(Halves halves, const SensorModel& chooser, const SurfelSettings& settings);

  const Sample& fitted() const { return halves_.fitted; }

  /// One model's residuals, turn by turn.
  struct Score {
    struct Turn {
      double weight = 0;
      double squares = 0;     ///< [m²] of distances to the surfaces
      double likelihood = 0;  ///< [nat] Σ of the log-likelihoods
      double lasers = 0;      ///< [m²] weighted squares of lasers' means about their surface's
      double sides = 0;       ///< [m²] of front and back about their laser's
      double entropy = 0;     ///< [nat] RQE of the turn's cloud
    };
    std::vector<Turn> turns;
  };
  Score score(const SensorModel& model) const;

  /// What `after` brought over `before`, with intervals by a bootstrap over turns, widened by Student's t for
  /// how few they are.
  static constexpr const char* kLikelihood = "log-likelihood a measurement";
  static std::vector<Gain> gains(const Score& before, const Score& after);

 private:
  Halves halves_;
  SurfelSettings settings_;
  Surfels surfels_;
  std::vector<float> told_noise_;  ///< of the beams that are held out, beside one another
  double noise_ = 0;               ///< [σ] of the residuals, by the chooser
};

}  // namespace crisp
