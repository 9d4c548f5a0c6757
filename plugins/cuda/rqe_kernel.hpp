// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>

// Computations of the graphics processor, written once for it and for the processor that tests it: constexpr
// functions and plain pointers, which nvcc compiles for both (--expt-relaxed-constexpr).
namespace crisp::cuda {

/// Number of points that are summed in parallel, and of neighbours that they process together.
inline constexpr std::uint32_t kLanes = 64;

/// Slots from first up to, not including, last.
struct SlotRange {
  std::uint32_t first;
  std::uint32_t last;
};

/// Up to kLanes points of one cell.
struct Unit {
  SlotRange slots;
  std::uint32_t cell;
};

/// Points, their order cell by cell, and where the neighbours of a cell's points are. Pointers to either
/// memory.
struct PlanView {
  const double* x;                  ///< [m] of each point
  const double* y;                  ///< [m]
  const double* z;                  ///< [m]
  const double* weight;             ///< of each point
  const std::uint32_t* index;       ///< of the point in each slot
  const Unit* units;                ///< each slot is in one
  const SlotRange* near;            ///< the cell itself and the up to 26 around it, list after list
  const std::uint64_t* near_begin;  ///< of each cell's list; one more than cells
};

/// The summed kernel of each pair: in kernel units, the squared distance of two points is −log₂ of their
/// kernel G / G(0).
struct PairKernel {
  double scale;    ///< [kernel units / m]
  double radius2;  ///< [kernel units²] of the cut-off
  double floor;    ///< G / G(0) at the cut-off
};

/// The sums of one point, over the points j nearer than the radius.
struct PointSums {
  double kernel = 0;           ///< Σⱼ wⱼ (G/G(0) − floor)
  double x = 0, y = 0, z = 0;  ///< Σⱼ wⱼ G/G(0) · (xᵢ − xⱼ) [kernel units]
  std::uint32_t pairs = 0;
};

/// A point as its unit sees it [kernel units].
template <class Real>
struct Neighbour {
  Real x, y, z, weight;
};

/// A slot's point relative to the point `origin`: subtracted in double precision, so that little is lost in
/// single precision of what is near.
template <class Real>
constexpr Neighbour<Real> relative(const PlanView& plan, std::uint32_t slot, std::uint32_t origin,
                                   double scale) {
  const std::uint32_t i = plan.index[slot];
  return {static_cast<Real>(scale * (plan.x[i] - plan.x[origin])),
          static_cast<Real>(scale * (plan.y[i] - plan.y[origin])),
          static_cast<Real>(scale * (plan.z[i] - plan.z[origin])), static_cast<Real>(plan.weight[i])};
}

/// Adds what a point gets from some neighbours, in their order: summed in Real, then in double precision.
template <class Real>
constexpr void add_neighbours(const Neighbour<Real>& own, const Neighbour<Real>* near, std::uint32_t count,
                              const PairKernel& kernel, PointSums& sums) {
  const Real radius2 = static_cast<Real>(kernel.radius2);
  const Real floor = static_cast<Real>(kernel.floor);
  Real total = 0;
  Real x = 0;
  Real y = 0;
  Real z = 0;
  for (std::uint32_t k = 0; k < count; ++k) {
    const Real dx = own.x - near[k].x;
    const Real dy = own.y - near[k].y;
    const Real dz = own.z - near[k].z;
    const Real distance2 = dx * dx + dy * dy + dz * dz;
    if (distance2 >= radius2) continue;
    const Real g = std::exp2(-distance2);
    total += near[k].weight * (g - floor);
    x += near[k].weight * g * dx;
    y += near[k].weight * g * dy;
    z += near[k].weight * g * dz;
    ++sums.pairs;
  }
  sums.kernel += total;
  sums.x += x;
  sums.y += y;
  sums.z += z;
}

/// Data shared by the lanes of a unit.
template <class Real>
struct Shared {
  Neighbour<Real> near[kLanes];
  double kernel[kLanes];
  std::uint64_t pairs[kLanes];
};

/// Data of one lane.
template <class Real>
struct Lane {
  Neighbour<Real> own{};
  PointSums sums{};
};

/// Output arrays of all units.
struct Results {
  double* x;  ///< of each point: wᵢ Σⱼ wⱼ G/G(0) · (xᵢ − xⱼ) [m]; null: unwanted
  double* y;
  double* z;
  double* kernel;        ///< of each unit: Σᵢ Σⱼ wᵢ wⱼ (G/G(0) − floor)
  std::uint64_t* pairs;  ///< of each unit: ordered pairs (i, j)
};

/// Sums one unit. Each point sums its own neighbours, in the order of the slots, and the points of a unit are
/// added pairwise: nothing depends on what runs when.
///
/// @param lanes  lanes.each(step) has all lanes take a step, step(number, lane), before any goes on
template <class Real, class Lanes>
constexpr void sum_unit(const PlanView& plan, const PairKernel& kernel, std::uint32_t number, Lanes& lanes,
                        Shared<Real>& shared, const Results& results) {
  const Unit unit = plan.units[number];
  const std::uint32_t first_slot = unit.slots.first;
  const std::uint32_t origin = plan.index[first_slot];
  const std::uint32_t members = unit.slots.last - unit.slots.first;
  lanes.each([&](std::uint32_t k, Lane<Real>& lane) {
    if (k < members) lane.own = relative<Real>(plan, first_slot + k, origin, kernel.scale);
  });
  for (std::uint64_t list = plan.near_begin[unit.cell]; list < plan.near_begin[unit.cell + 1]; ++list) {
    const SlotRange range = plan.near[list];
    for (std::uint32_t first = range.first; first < range.last; first += kLanes) {
      const std::uint32_t count = range.last - first < kLanes ? range.last - first : kLanes;
      lanes.each([&](std::uint32_t k, Lane<Real>&) {
        if (k < count) shared.near[k] = relative<Real>(plan, first + k, origin, kernel.scale);
      });
      lanes.each([&](std::uint32_t k, Lane<Real>& lane) {
        if (k < members) add_neighbours(lane.own, shared.near, count, kernel, lane.sums);
      });
    }
  }
  lanes.each([&](std::uint32_t k, Lane<Real>& lane) {
    shared.kernel[k] = 0;
    shared.pairs[k] = lane.sums.pairs;
    if (k >= members) return;
    const std::uint32_t i = plan.index[first_slot + k];
    shared.kernel[k] = plan.weight[i] * lane.sums.kernel;
    if (results.x == nullptr) return;
    const double factor = plan.weight[i] / kernel.scale;
    results.x[i] = factor * lane.sums.x;
    results.y[i] = factor * lane.sums.y;
    results.z[i] = factor * lane.sums.z;
  });
  for (std::uint32_t half = kLanes / 2; half > 0; half /= 2) {
    lanes.each([&](std::uint32_t k, Lane<Real>&) {
      if (k >= half) return;
      shared.kernel[k] += shared.kernel[k + half];
      shared.pairs[k] += shared.pairs[k + half];
    });
  }
  lanes.each([&](std::uint32_t k, Lane<Real>&) {
    if (k != 0) return;
    results.kernel[number] = shared.kernel[0];
    results.pairs[number] = shared.pairs[0];
  });
}

}  // namespace crisp::cuda
