// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <crisp/findings.hpp>

#include "pipeline/estimate/placed_beams.hpp"
#include "pipeline/estimate/sample.hpp"
#include "pipeline/quality/surfels.hpp"

namespace crisp::diagnose {

/// Two-fold split of a sample by turns of the plate or by recordings: a training half and a held-out half.
struct Halves {
  estimate::Sample fitted;
  estimate::Sample held_out;
  std::vector<std::uint32_t> turn;  ///< turn of each held-out beam, from 0
};

/// Splits by recordings if there are several, otherwise by turns of the plate. A recording of fewer than four
/// turns is split by pieces of 15°, or by eighths if these are shorter: half of a turn alone leaves the
/// harmonics of the plate angle open.
Halves halves_of(const estimate::Sample& sample);

/// Held-out cross-validation of sensor models by the distances of beams to surfaces. The beams and their
/// surfaces are selected once, with a model that has none of the terms under test. Rigid motions of a whole
/// cloud count for nothing: two fits may differ by a rotation that the data do not determine.
class CrossValidator {
 public:
  CrossValidator(Halves halves, const SensorModel& chooser, const quality::SurfelSettings& settings);

  const estimate::Sample& fitted() const { return halves_.fitted; }

  /// Held-out score of one model, per turn.
  struct Score {
    struct Turn {
      double weight = 0;
      double squares = 0;     ///< [m²] weighted squared distances to the surfaces
      double likelihood = 0;  ///< [nat] sum of the log-likelihoods
      double lasers = 0;      ///< [m²] weighted squares of the lasers' means about their surface's mean
      double sides = 0;       ///< [m²] weighted squares of front and back means about their laser's mean
      double entropy = 0;     ///< [nat] RQE of the turn's cloud
    };
    std::vector<Turn> turns;
  };
  Score score(const SensorModel& model) const;

  /// Differences between two scores, with confidence intervals of a bootstrap over turns. Student's t widens
  /// the intervals for the small number of turns.
  static constexpr const char* kLikelihood = "log-likelihood a measurement";
  static std::vector<Gain> gains(const Score& before, const Score& after);

 private:
  Halves halves_;
  quality::SurfelSettings settings_;
  quality::Surfels surfels_;
  std::optional<estimate::PlacedBeams> reference_;  ///< the held-out beams by the selecting model
  std::vector<float> given_noise_;                  ///< relative noise of the held-out beams
  double noise_ = 0;                                ///< [σ] of the residuals of the selecting model
};

}  // namespace crisp::diagnose
