// SPDX-License-Identifier: BSD-3-Clause
// Compiled once for each instruction set, and chosen from when the program runs (Google Highway).
#include "pipeline/quality/run_costs.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pipeline/quality/run_costs.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace crisp::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class Tag>
HWY_INLINE void some_run_costs(Tag tag, const LineColumns& beginnings, const double (&here)[6], std::size_t k,
                               double* cost) {
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
  hn::StoreU(hn::Add(hn::LoadU(tag, beginnings.price + k), left), tag, cost + k);
}

void run_costs(const LineColumns& beginnings, const double (&here)[6], std::size_t n, double* cost) {
  const hn::ScalableTag<double> many;
  const hn::CappedTag<double, 1> one;
  std::size_t k = 0;
  for (; k + hn::Lanes(many) <= n; k += hn::Lanes(many)) some_run_costs(many, beginnings, here, k, cost);
  for (; k < n; ++k) some_run_costs(one, beginnings, here, k, cost);
}

}  // namespace crisp::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace crisp::simd {

HWY_EXPORT(run_costs);

void run_costs(const LineColumns& beginnings, const double (&here)[6], std::size_t n, double* cost) {
  HWY_DYNAMIC_DISPATCH(run_costs)(beginnings, here, n, cost);
}

}  // namespace crisp::simd
#endif
