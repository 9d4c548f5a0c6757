// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/model/added_terms.hpp"

#include <utility>

namespace crisp::model {
namespace {

ChainPlace end_of(const LaserChain& chain, Phase phase) {
  return {phase, chain.phases[static_cast<std::size_t>(phase)].size()};
}

}  // namespace

AddedTerms::AddedTerms(SensorModel model, const std::vector<std::vector<AddedTerm>>& of_laser)
    : model_(std::move(model)) {
  for (std::size_t laser = 0; laser < model_.lasers(); ++laser) {
    const LaserChain& chain = model_.chain(laser);
    std::vector<VariedTerm> varied;
    for (const AddedTerm& added : laser < of_laser.size() ? of_laser[laser] : std::vector<AddedTerm>{}) {
      varied.push_back({.term = added.term,
                        .place = end_of(chain, added.term->info().phase),
                        .values = added.values,
                        .parameters = added.parameters,
                        .columns = added.columns});
    }
    of_laser_.emplace_back(chain, chain_values(chain, model_.values()), std::vector<SeededSlot>{}, varied);
  }
}

void AddedTerms::fill_rows(const Measurements& beams, const PlateTrajectory& plate,
                           const Eigen::Vector3d& normal, std::size_t stride, std::span<double> rows) const {
  auto of_laser = of_laser_;  // each call its own, for their beams
  for (std::size_t begin = 0; begin < beams.size();) {
    check_laser(of_laser.size(), beams, begin);
    begin = of_laser[beams.laser[begin]].differentiate(
        beams, begin, plate, normal.transpose(), [](std::size_t, const Eigen::Vector3d&) {},
        [&](std::size_t i, std::size_t column, const Eigen::Matrix<double, 1, 1>& moved) {
          rows[i * stride + column] = moved.value();
        });
  }
}

}  // namespace crisp::model
