// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/cross_validation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <crisp/error.hpp>

#include "pipeline/estimate/displacement.hpp"
#include "pipeline/estimate/free_parameters.hpp"

namespace crisp::estimate {
namespace {

constexpr std::size_t kInBothHalves = 500'000;

Sample turns_of(const Sample& sample, int parity) {
  return select(sample, [&](std::size_t i) {
    const auto plate = sample.plate->at(sample.beams.time[i]);
    if (!plate) return false;
    const double turn = std::floor(plate->angle / (2 * std::numbers::pi));
    return std::fmod(std::abs(turn), 2) == parity;
  });
}

}  // namespace

std::optional<CrossValidation> cross_validate(const SensorModel& model, const Sample& sample,
                                              const RefinementSettings& settings, const RoundReporter& go_on,
                                              const std::shared_ptr<const SurfaceMap>& known) {
  if (turned(sample) < 2 * 2 * std::numbers::pi) return std::nullopt;
  const Sample some = thin_evenly(sample, kInBothHalves, 1);
  RefinementSettings of_half = settings;
  of_half.detail = Detail::kStandardErrors;
  std::array<std::optional<Outcome>, 2> halves;
  for (const int parity : {0, 1}) {
    try {
      halves.at(static_cast<std::size_t>(parity)) =
          refine_by_surfels(model, turns_of(some, parity), of_half, go_on, known).outcome;
    } catch (const Error&) {
      return std::nullopt;  // nothing is flat in half of the beams, or nothing is determined
    }
  }
  const Outcome& first = *halves[0];
  const Outcome& second = *halves[1];
  if (first.free != second.free) return std::nullopt;
  const LagRange lags = lag_range(model, 0);
  const Eigen::MatrixXd cloud = displacement(model, covered(some, lags.earliest, lags.latest), first.free);
  const Eigen::VectorXd apart = picked(first.model, first.free) - picked(second.model, first.free);
  const double expected = cloud.cwiseProduct(first.covariance + second.covariance).sum();
  if (!(expected > 0)) return std::nullopt;
  return CrossValidation{.difference = std::sqrt(std::max(0.0, apart.dot(cloud * apart))),
                         .expected = std::sqrt(expected)};
}

}  // namespace crisp::estimate
