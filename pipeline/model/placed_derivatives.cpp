// SPDX-License-Identifier: BSD-3-Clause
// Points with their derivatives: of equation (2) alone in closed form, of chains with terms by automatic
// differentiation.
#include <algorithm>

#include <crisp/sensor_model.hpp>

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

/// The parameters of each laser; the free ones from column `first` on are seeded in a Jet's derivatives.
std::vector<std::vector<Jet>> seeded_parameters(const std::vector<LaserChain>& chains,
                                                const Eigen::VectorXd& values, const FreeSlots& free,
                                                std::size_t first) {
  std::vector<std::vector<Jet>> all;
  for (std::size_t laser = 0; laser < chains.size(); ++laser) {
    const auto plain = chain_values(chains[laser], values);
    auto& seeded = all.emplace_back(plain.begin(), plain.end());
    const auto& own = free.slots[laser];
    const std::size_t last = std::min(first + static_cast<std::size_t>(Jet::DIMENSION), own.size());
    for (std::size_t k = first; k < last; ++k) seeded[own[k]].v[static_cast<Eigen::Index>(k - first)] = 1;
  }
  return all;
}

/// Placed points and their derivatives, where all chains are equation (2) alone.
Placed place_bare(const Measurements& beams, const PlateTrajectory& plate,
                  const std::vector<LaserChain>& chains, std::span<const simd::BareLaser> lasers,
                  const FreeSlots& free, PointDerivatives& derivatives) {
  Placed result;
  result.points.resize(3, static_cast<Eigen::Index>(beams.size()));
  result.index.reserve(beams.size());
  MixedBeams mixed(lasers, plate);
  for (std::size_t i = 0; i < beams.size();) {
    mixed.clear();
    const std::size_t end = std::min(beams.size(), i + mixed.room());
    for (std::size_t k = i; k < end; ++k) chain_of(chains, beams, k);
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

/// Derivatives of placed points by automatic differentiation, in as many passes as it takes to seed every
/// free parameter in one of a Jet's derivatives.
void differentiate(const Measurements& beams, const PlateTrajectory& plate,
                   const std::vector<LaserChain>& chains, const Eigen::VectorXd& values,
                   const FreeSlots& slots, PointDerivatives& derivatives) {
  constexpr std::size_t kWidth = Jet::DIMENSION;
  for (std::size_t first = 0; first < derivatives.stride; first += kWidth) {
    const auto seeded = seeded_parameters(chains, values, slots, first);
    const auto count = static_cast<Eigen::Index>(std::min(kWidth, derivatives.stride - first));
    auto column = static_cast<Eigen::Index>(first);
    Tracer<Jet> tracer(beams, plate);
    for (std::size_t i = 0; i < beams.size();) {
      const std::size_t laser = beams.laser[i];
      i = tracer.trace_run(chains[laser], seeded[laser], i, [&](std::size_t, const Beam<Jet>& beam) {
        const Vector3<Jet> x = beam.point();
        for (int axis = 0; axis < 3; ++axis) {
          derivatives.values.row(axis).segment(column, count) = x[axis].v.head(count).transpose();
        }
        column += static_cast<Eigen::Index>(derivatives.stride);
      });
    }
  }
}

}  // namespace

Placed SensorModel::place(const Measurements& beams, const PlateTrajectory& plate,
                          const std::vector<std::size_t>& free, PointDerivatives& derivatives) const {
  check_epochs(beams, plate);
  const FreeSlots slots = free_slots(fixed_->chains, free);
  derivatives.columns = slots.columns;
  derivatives.stride = 0;
  for (const auto& columns : slots.columns) derivatives.stride = std::max(derivatives.stride, columns.size());
  const auto room_for = [&](std::size_t points) {
    derivatives.values.setZero(3, static_cast<Eigen::Index>(points * derivatives.stride));
  };
  if (std::ranges::all_of(fixed_->chains, &LaserChain::bare)) {
    room_for(beams.size());
    return place_bare(beams, plate, fixed_->chains, *bare_, slots, derivatives);
  }
  Placed result = place(beams, plate);
  room_for(result.index.size());
  differentiate(beams, plate, fixed_->chains, values_, slots, derivatives);
  return result;
}

}  // namespace crisp
