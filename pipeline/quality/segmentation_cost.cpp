// SPDX-License-Identifier: BSD-3-Clause
// Compiled once for each instruction set, and chosen from when the program runs (Google Highway).
#include "pipeline/quality/segmentation_cost.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pipeline/quality/segmentation_cost.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace crisp::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class Tag>
HWY_INLINE hn::Vec<Tag> some_run_costs(Tag tag, const LineColumns& beginnings, const double (&here)[6],
                                       std::size_t k, double* cost) {
  const auto column = [&](std::size_t c) {
    return hn::Sub(hn::Set(tag, here[c]), hn::LoadU(tag, beginnings.sums[c] + k));
  };
  const auto xx = column(0);
  const auto xy = column(1);
  const auto yy = column(2);
  const auto x = column(3);
  const auto y = column(4);
  const auto determinant = hn::Sub(hn::Mul(xx, yy), hn::Mul(xy, xy));
  const auto by_two = hn::Add(hn::Mul(x, hn::Sub(hn::Mul(yy, x), hn::Mul(xy, y))),
                              hn::Mul(y, hn::Sub(hn::Mul(xx, y), hn::Mul(xy, x))));
  const auto by_one = hn::Add(hn::Mul(x, x), hn::Mul(y, y));
  const auto two = hn::Gt(determinant, hn::Mul(hn::Set(tag, kOneDirection), hn::Mul(xx, yy)));
  const auto fitted =
      hn::Div(hn::IfThenElse(two, by_two, by_one), hn::IfThenElse(two, determinant, hn::Add(xx, yy)));
  const auto left = hn::Max(hn::Zero(tag), hn::Sub(column(5), fitted));
  const auto costs = hn::Add(hn::LoadU(tag, beginnings.price + k), left);
  hn::StoreU(costs, tag, cost + k);
  return costs;
}

CheapestRun run_costs(const LineColumns& beginnings, const double (&here)[6], std::size_t n, double* cost) {
  const hn::ScalableTag<double> many;
  const hn::CappedTag<double, 1> one;
  auto least = hn::Set(many, hwy::HighestValue<double>());
  std::size_t k = 0;
  for (; k + hn::Lanes(many) <= n; k += hn::Lanes(many)) {
    least = hn::Min(least, some_run_costs(many, beginnings, here, k, cost));
  }
  double lowest = hn::GetLane(hn::MinOfLanes(many, least));
  for (; k < n; ++k) lowest = HWY_MIN(lowest, hn::GetLane(some_run_costs(one, beginnings, here, k, cost)));

  const auto sought = hn::Set(many, lowest);
  for (k = 0; k + hn::Lanes(many) <= n; k += hn::Lanes(many)) {
    const auto found = hn::FindFirstTrue(many, hn::Eq(hn::LoadU(many, cost + k), sought));
    if (found >= 0) return {k + static_cast<std::size_t>(found), lowest};
  }
  while (k + 1 < n && cost[k] != lowest) ++k;
  return {k, lowest};
}

}  // namespace crisp::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace crisp::simd {

HWY_EXPORT(run_costs);

CheapestRun run_costs(const LineColumns& beginnings, const double (&here)[6], std::size_t n, double* cost) {
  return HWY_DYNAMIC_DISPATCH(run_costs)(beginnings, here, n, cost);
}

}  // namespace crisp::simd
#endif
