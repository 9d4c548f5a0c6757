// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/recording_lags.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <crisp/error.hpp>

#include "pipeline/data/recordings.hpp"
#include "pipeline/estimate/base_parameters.hpp"

namespace crisp::estimate {
namespace {

/// Nothing where no surface is flat, or η is not identifiable.
std::optional<Outcome> lags_alone(const SensorModel& model, const Sample& recording,
                                  RefinementSettings settings) {
  settings.fixed = {"lambda", "tau", "alpha"};
  settings.terms.clear();
  settings.detail = Detail::kStandardErrors;
  try {
    return refine_by_surfels(model, recording, settings).outcome;
  } catch (const Error&) {
    return {};
  }
}

}  // namespace

RecordingLags lags_of_recordings(const SensorModel& model, const Sample& sample,
                                 const RefinementSettings& settings) {
  const data::RecordingNumbers number(*sample.plate);
  const auto recordings = static_cast<Eigen::Index>(number.count());
  const auto lasers = static_cast<Eigen::Index>(model.lasers());
  RecordingLags lags{
      .beyond = Eigen::MatrixXd::Zero(recordings, lasers),
      .std_errors = Eigen::MatrixXd::Constant(recordings, lasers, std::numeric_limits<double>::infinity())};
  if (recordings < 2) return lags;
  for (Eigen::Index k = 0; k < recordings; ++k) {
    const Sample own = select(sample, [&](std::size_t i) {
      return number.of(sample.beams.time[i]) == static_cast<std::size_t>(k);
    });
    const auto found = lags_alone(model, own, settings);
    if (!found) continue;
    for (Eigen::Index laser = 0; laser < lasers; ++laser) {
      const std::size_t eta = slot(model, static_cast<std::size_t>(laser), kEta);
      const auto at = std::ranges::find(found->free, eta);
      if (at == found->free.end()) continue;
      const auto column = static_cast<Eigen::Index>(at - found->free.begin());
      lags.beyond(k, laser) = found->model.values()[static_cast<Eigen::Index>(eta)];
      lags.std_errors(k, laser) = std::sqrt(found->covariance(column, column));
    }
  }
  const Eigen::ArrayXXd weights = lags.std_errors.array().square().inverse();
  for (Eigen::Index laser = 0; laser < lasers; ++laser) {
    const double all = weights.col(laser).sum();
    if (!(all > 0)) continue;
    const double mean = (weights.col(laser) * lags.beyond.col(laser).array()).sum() / all;
    lags.beyond.col(laser) = (weights.col(laser) > 0).select(lags.beyond.col(laser).array() - mean, 0.0);
  }
  return lags;
}

Sample with_common_lags(Sample sample, const RecordingLags& lags) {
  const data::RecordingNumbers number(*sample.plate);
  for (std::size_t i = 0; i < sample.beams.size(); ++i) {
    sample.beams.time[i] += lags.beyond(static_cast<Eigen::Index>(number.of(sample.beams.time[i])),
                                        static_cast<Eigen::Index>(sample.beams.laser[i]));
  }
  return sample;
}

}  // namespace crisp::estimate
