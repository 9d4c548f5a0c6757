// SPDX-License-Identifier: BSD-3-Clause
// Compiled once for each instruction set, and chosen from when the program runs (Google Highway).
#include "plugins/assemble/pack_points.hpp"

#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "plugins/assemble/pack_points.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace crisp::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// A point is four words: (x, y), (z, 1), (intensity, laser, beam) and time, of each the first in the lowest
// bits.
static_assert(std::endian::native == std::endian::little && sizeof(Point) == 4 * sizeof(std::uint64_t));
static_assert(offsetof(Point, data) == 0 && offsetof(Point, intensity) == 16 &&
              offsetof(Point, laser) == 20 && offsetof(Point, beam) == 22 && offsetof(Point, time) == 24);

/// Packs as many points as D has lanes, from the i-th on.
template <class D>
HWY_INLINE void pack(D doubles, const PointArrays& from, std::size_t i, std::uint64_t* words) {
  const hn::RebindToUnsigned<D> to_words;
  const hn::Rebind<float, D> floats;
  const hn::Rebind<std::uint32_t, D> halves;
  const hn::Rebind<std::uint16_t, D> quarters;
  const auto coordinate = [&](const double* values) {
    const auto rounded = hn::DemoteTo(floats, hn::LoadU(doubles, values + i));
    return hn::PromoteTo(to_words, hn::BitCast(halves, rounded));
  };
  const auto quarter = [&](const std::uint16_t* values) {
    return hn::PromoteTo(halves, hn::LoadU(quarters, values + i));
  };
  const auto one = hn::Set(to_words, std::uint64_t{std::bit_cast<std::uint32_t>(1.0F)} << 32);
  const auto intensity = hn::BitCast(halves, hn::LoadU(floats, from.intensity + i));
  const auto who = hn::Or(quarter(from.laser), hn::ShiftLeft<16>(quarter(from.beam)));
  hn::StoreInterleaved4(
      hn::Or(coordinate(from.x), hn::ShiftLeft<32>(coordinate(from.y))), hn::Or(coordinate(from.z), one),
      hn::Or(hn::PromoteTo(to_words, intensity), hn::ShiftLeft<32>(hn::PromoteTo(to_words, who))),
      hn::BitCast(to_words, hn::LoadU(doubles, from.time + i)), to_words, words);
}

void pack_points(const PointArrays& from, Point* to) {
  constexpr hn::ScalableTag<double> kMany;
  constexpr hn::CappedTag<double, 1> kOne;
  auto* words = reinterpret_cast<std::uint64_t*>(to);
  std::size_t i = 0;
  for (; i + hn::Lanes(kMany) <= from.size; i += hn::Lanes(kMany)) pack(kMany, from, i, words + 4 * i);
  for (; i < from.size; ++i) pack(kOne, from, i, words + 4 * i);
}

}  // namespace crisp::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace crisp::simd {

HWY_EXPORT(pack_points);

void pack_points(const PointArrays& from, Point* to) { HWY_DYNAMIC_DISPATCH(pack_points)(from, to); }

}  // namespace crisp::simd
#endif
