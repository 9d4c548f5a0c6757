// SPDX-License-Identifier: BSD-3-Clause
// Points with their derivatives: of equation (2) alone in closed form, of chains with terms by the chain
// rule.
#include <algorithm>
#include <cstddef>
#include <utility>

#include <crisp/sensor_model.hpp>

#include "pipeline/model/chain_jacobian.hpp"
#include "pipeline/model/mixed_batch.hpp"
#include "pipeline/model/traced_runs.hpp"

namespace crisp {
namespace {

/// For each laser, the free parameters that it depends on and the slot of each in its chain.
struct FreeSlots {
  std::vector<std::vector<std::size_t>> columns;  ///< index into the list of free parameters
  std::vector<std::vector<std::size_t>> slots;    ///< index into the laser's slots
};

FreeSlots free_slots(const std::vector<LaserChain>& chains, const std::vector<std::size_t>& free) {
  FreeSlots result;
  for (const auto& chain : chains) {
    auto& columns = result.columns.emplace_back();
    auto& slots = result.slots.emplace_back();
    for (std::size_t f = 0; f < free.size(); ++f) {
      const auto slot = std::find(chain.slots.begin(), chain.slots.end(), free[f]);
      if (slot == chain.slots.end()) continue;
      columns.push_back(f);
      slots.push_back(static_cast<std::size_t>(slot - chain.slots.begin()));
    }
  }
  return result;
}

/// Placed points and their derivatives, where all chains are equation (2) alone.
Placed place_bare(const Measurements& beams, const PlateTrajectory& plate,
                  const std::vector<LaserChain>& chains, std::span<const simd::BareLaser> lasers,
                  const FreeSlots& free, PointDerivatives& derivatives) {
  Placed result;
  result.points.resize(3, static_cast<Eigen::Index>(beams.size()));
  result.index.reserve(beams.size());
  model::MixedBeams mixed(lasers, plate);
  for (std::size_t i = 0; i < beams.size();) {
    mixed.clear();
    const std::size_t end = std::min(beams.size(), i + mixed.room());
    for (std::size_t k = i; k < end; ++k) model::chain_of(chains, beams, k);
    mixed.add(beams, i, end);
    i = end;
    mixed.place();
    for (std::size_t k = 0; k < mixed.size(); ++k) {
      const std::size_t point = result.index.size();
      const std::uint32_t measurement = mixed.index(k);
      result.points.col(static_cast<Eigen::Index>(point)) << mixed.x(k), mixed.y(k), mixed.z(k);
      result.index.push_back(measurement);
      const auto slopes = mixed.slopes(k);
      auto column = static_cast<Eigen::Index>(point * derivatives.stride);
      for (const std::size_t slot : free.slots[beams.laser[measurement]]) {
        derivatives.values.col(column++).head<2>() << slopes[slot][0], slopes[slot][1];
      }
    }
  }
  const auto placed = static_cast<Eigen::Index>(result.index.size());
  result.points.conservativeResize(Eigen::NoChange, placed);
  derivatives.values.conservativeResize(Eigen::NoChange,
                                        placed * static_cast<Eigen::Index>(derivatives.stride));
  return result;
}

/// The terms of a chain that have free parameters.
///
/// @param slots  of the free parameters, which are numbered by column
std::vector<model::VariedTerm> varied_terms(const LaserChain& chain, const std::vector<double>& values,
                                            const std::vector<std::size_t>& slots) {
  std::vector<model::VariedTerm> varied;
  for (std::size_t p = 0; p < chain.phases.size(); ++p) {
    const auto phase = static_cast<Phase>(p);
    const auto& terms = chain.phases[p];
    for (std::size_t k = 0; k < terms.size(); ++k) {
      const auto count = terms[k].term->info().parameters.size();
      const auto first = values.begin() + static_cast<std::ptrdiff_t>(terms[k].first_slot);
      model::VariedTerm own{.term = terms[k].term,
                            .place = {phase, model::is_reading(phase) ? terms.size() : k},
                            .values = {first, first + static_cast<std::ptrdiff_t>(count)},
                            .parameters = {},
                            .columns = {}};
      for (std::size_t column = 0; column < slots.size(); ++column) {
        if (slots[column] < terms[k].first_slot || slots[column] >= terms[k].first_slot + count) continue;
        own.parameters.push_back(slots[column] - terms[k].first_slot);
        own.columns.push_back(column);
      }
      if (!own.columns.empty()) varied.push_back(std::move(own));
    }
  }
  return varied;
}

/// The first `count` slots of a chain that are free.
std::vector<model::SeededSlot> seeded_slots(const std::vector<std::size_t>& slots, std::size_t count) {
  std::vector<model::SeededSlot> seeded;
  for (std::size_t column = 0; column < slots.size(); ++column) {
    if (slots[column] < count) seeded.push_back({.slot = slots[column], .column = column});
  }
  return seeded;
}

/// @param slots  of the free parameters, which are numbered by column
model::ChainJacobian<3> jacobian_of(const LaserChain& chain, const Eigen::VectorXd& all,
                                    const std::vector<std::size_t>& slots) {
  const auto values = model::chain_values(chain, all);
  // Few parameters are differentiated at once.
  if (slots.size() <= static_cast<std::size_t>(Jet::DIMENSION))
    return {chain, values, seeded_slots(slots, chain.slots.size()), {}};
  return {chain, values, seeded_slots(slots, model::kBaseParameters), varied_terms(chain, values, slots)};
}

/// Placed points and their derivatives, where chains have terms.
Placed place_chains(const Measurements& beams, const PlateTrajectory& plate,
                    const std::vector<LaserChain>& chains, const Eigen::VectorXd& values,
                    const FreeSlots& free, PointDerivatives& derivatives) {
  std::vector<model::ChainJacobian<3>> of_laser;
  for (std::size_t laser = 0; laser < chains.size(); ++laser)
    of_laser.push_back(jacobian_of(chains[laser], values, free.slots[laser]));
  Placed result;
  result.points.resize(3, static_cast<Eigen::Index>(beams.size()));
  result.index.reserve(beams.size());
  std::vector<Eigen::Index> first_column(beams.size());
  for (std::size_t i = 0; i < beams.size();) {
    model::check_laser(of_laser.size(), beams, i);
    i = of_laser[beams.laser[i]].differentiate(
        beams, i, plate, Eigen::Matrix3d::Identity(),
        [&](std::size_t k, const Eigen::Vector3d& end) {
          first_column[k] = static_cast<Eigen::Index>(result.index.size() * derivatives.stride);
          result.points.col(static_cast<Eigen::Index>(result.index.size())) = end;
          result.index.push_back(static_cast<std::uint32_t>(k));
        },
        [&](std::size_t k, std::size_t column, const Eigen::Vector3d& moved) {
          derivatives.values.col(first_column[k] + static_cast<Eigen::Index>(column)) = moved;
        });
  }
  result.points.conservativeResize(Eigen::NoChange, static_cast<Eigen::Index>(result.index.size()));
  derivatives.values.conservativeResize(Eigen::NoChange,
                                        static_cast<Eigen::Index>(result.index.size() * derivatives.stride));
  return result;
}

}  // namespace

Placed SensorModel::place(const Measurements& beams, const PlateTrajectory& plate,
                          const std::vector<std::size_t>& free, PointDerivatives& derivatives) const {
  model::check_epochs(beams, plate);
  const FreeSlots slots = free_slots(fixed_->chains, free);
  derivatives.columns = slots.columns;
  derivatives.stride = 0;
  for (const auto& columns : slots.columns) derivatives.stride = std::max(derivatives.stride, columns.size());
  derivatives.values.setZero(3, static_cast<Eigen::Index>(beams.size() * derivatives.stride));
  return std::ranges::all_of(fixed_->chains, &LaserChain::bare)
             ? place_bare(beams, plate, fixed_->chains, *bare_, slots, derivatives)
             : place_chains(beams, plate, fixed_->chains, values_, slots, derivatives);
}

}  // namespace crisp
