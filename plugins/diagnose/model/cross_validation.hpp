// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
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
  std::vector<std::uint32_t> turn;   ///< turn of each held-out beam, from 0
  std::vector<std::uint32_t> piece;  ///< and its eighth of a turn, or its turn where these are shorter
};

/// Splits by recordings if there are several, otherwise by turns of the plate. A recording of fewer than four
/// turns is split by pieces of 15°, or by eighths if these are shorter: half of a turn alone leaves the
/// harmonics of the plate angle open.
///
/// @param held_out  which half is held out, 0 or 1
Halves halves_of(const estimate::Sample& sample, std::uint32_t held_out = 1);

/// Held-out cross-validation of sensor models by the distances of beams to surfaces, which are selected once.
/// A model fits best where its own surfaces are, so the two models that are compared select in turn, and each
/// is scored on the surfaces of both. Rigid motions of a whole cloud count for nothing: two fits may differ
/// by a rotation that the data do not determine.
class CrossValidator {
 public:
  /// @param choosers  models that select surfaces: without the terms under test, and with all of them
  CrossValidator(Halves halves, const std::vector<SensorModel>& choosers,
                 const quality::SurfelSettings& settings);

  const estimate::Sample& fitted() const { return halves_.fitted; }

  /// Held-out score of one model: sums over the beams of each piece, and of each turn, on the surfaces of
  /// every chooser.
  struct Score {
    struct Sums {
      double weight = 0;
      double squares = 0;     ///< [m²] weighted squared distances to the surfaces
      double likelihood = 0;  ///< [nat] sum of the log-likelihoods
      double lasers = 0;      ///< [m²] weighted squares of the lasers' means about their surface's mean
      double sides = 0;       ///< [m²] weighted squares of front and back means about their laser's mean
      double entropy = 0;     ///< [nat] RQE of the turn's cloud; of turns only
    };
    std::vector<Sums> pieces;
    std::vector<Sums> turns;  ///< weight and entropy only

    /// Joins the score of the other half, held out by another validator.
    void append(const Score& other);
  };
  Score score(const SensorModel& model) const;

  /// Differences between two scores, with confidence intervals of a bootstrap over pieces; over turns for the
  /// RQE. Student's t widens the intervals for a small number of them. A short recording has a few turns only
  /// to hold out, and what settles or warms up is in one of them.
  static constexpr const char* kLikelihood = "log-likelihood a measurement";
  static std::vector<Gain> gains(const Score& before, const Score& after);

 private:
  /// Surfaces that one chooser selects in the held-out half.
  struct Choice {
    estimate::Sample held_out;  ///< with the incidence on these surfaces
    quality::Surfels surfels;
    estimate::PlacedBeams reference;  ///< the held-out beams by the chooser
    std::vector<float> given_noise;   ///< relative noise of the held-out beams
    double noise = 0;                 ///< [σ] of the chooser's residuals
  };
  Choice choice_of(const SensorModel& chooser) const;
  void add(const Choice& choice, const SensorModel& model, Score& score) const;

  Halves halves_;
  quality::SurfelSettings settings_;
  std::vector<Choice> choices_;
};

}  // namespace crisp::diagnose
