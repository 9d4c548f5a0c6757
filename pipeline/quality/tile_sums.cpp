// SPDX-License-Identifier: BSD-3-Clause
// Compiled once for each instruction set, and chosen from when the program runs (Google Highway).
#include "pipeline/quality/tile_sums.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pipeline/quality/tile_sums.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace crisp::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, kPadding>;
using Vector = hn::Vec<Floats>;
constexpr Floats kFloats;

/// 2^−t: the whole part goes into the exponent, a polynomial of degree 6 (minimax on ±½, 2e-9) does the rest.
HWY_INLINE Vector exp2_minus(Vector t) {
  const hn::RebindToSigned<Floats> integers;
  const Vector magic = hn::Set(kFloats, 12582912.0F);  // 1.5 · 2²³: adding it rounds to whole numbers
  const Vector shifted = hn::Sub(magic, t);
  const Vector part = hn::Sub(hn::Sub(magic, shifted), t);
  Vector p = hn::Set(kFloats, 0x1.41d334p-13F);
  p = hn::MulAdd(p, part, hn::Set(kFloats, 0x1.5f456ap-10F));
  p = hn::MulAdd(p, part, hn::Set(kFloats, 0x1.3b2dbcp-7F));
  p = hn::MulAdd(p, part, hn::Set(kFloats, 0x1.c6aed4p-5F));
  p = hn::MulAdd(p, part, hn::Set(kFloats, 0x1.ebfbdap-3F));
  p = hn::MulAdd(p, part, hn::Set(kFloats, 0x1.62e43p-1F));
  p = hn::MulAdd(p, part, hn::Set(kFloats, 1.0F));
  const auto whole = hn::ShiftLeft<23>(hn::BitCast(integers, shifted));
  return hn::BitCast(kFloats, hn::Add(hn::BitCast(integers, p), whole));
}

HWY_INLINE double middle(const TileArrays& tiles, std::size_t axis, std::size_t tile) {
  return 0.5 * (tiles.low[axis][tile] + tiles.high[axis][tile]);
}

/// Points that one tile is to be paired with, side by side, relative to that tile's middle.
struct Partners {
  static constexpr std::size_t kCapacity = 1024;

  HWY_ALIGN float at[3][kCapacity + 2 * kPadding];
  HWY_ALIGN float weight[kCapacity + 2 * kPadding];
  HWY_ALIGN float gradient[3][kCapacity + 2 * kPadding];
  std::uint32_t tile[kCapacity];  // whence
  std::size_t tiles = 0;
  std::size_t size = 0;

  bool full() const { return size + kPadding > kCapacity; }

  HWY_INLINE void add(const TileArrays& from, double scale, std::size_t b, std::size_t a) {
    const std::size_t slot = from.begin[b];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Vector apart =
          hn::Set(kFloats, static_cast<float>(scale * (middle(from, axis, b) - middle(from, axis, a))));
      for (std::size_t k = 0; k < kPadding; k += hn::Lanes(kFloats)) {
        hn::StoreU(hn::Add(hn::LoadU(kFloats, from.offset[axis] + slot + k), apart), kFloats,
                   at[axis] + size + k);
      }
    }
    for (std::size_t k = 0; k < kPadding; k += hn::Lanes(kFloats)) {
      hn::StoreU(hn::LoadU(kFloats, from.weight + slot + k), kFloats, weight + size + k);
    }
    tile[tiles++] = static_cast<std::uint32_t>(b);
    size += from.begin[b + 1] - slot;
  }

  /// Pads beyond the last partner with finite coordinates outside of every kernel: 0 · NaN is not 0.
  HWY_INLINE void close() {
    for (std::size_t k = 0; k < kPadding; k += hn::Lanes(kFloats)) {
      for (auto& axis : at) hn::StoreU(hn::Set(kFloats, 1e15F), kFloats, axis + size + k);
      hn::StoreU(hn::Zero(kFloats), kFloats, weight + size + k);
    }
  }

  HWY_INLINE void clear_gradient() {
    for (auto& axis : gradient) {
      for (std::size_t k = 0; k < size; k += hn::Lanes(kFloats))
        hn::Store(hn::Zero(kFloats), kFloats, axis + k);
    }
  }

  HWY_INLINE void give_gradient(const TileArrays& from, TaskSums& sums) const {
    std::size_t k = 0;
    for (std::size_t t = 0; t < tiles; ++t) {
      const std::size_t begin = from.begin[tile[t]];
      const std::size_t count = from.begin[tile[t] + 1] - begin;
      const std::size_t slot = begin - from.begin[sums.first_tile];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t i = 0; i < count; ++i) sums.gradient[axis][slot + i] += gradient[axis][k + i];
      }
      k += count;
    }
  }
};

/// Pairs each point of tile a with all partners; a symmetric pair counts for both.
template <bool kSymmetric, bool kGradient>
HWY_INLINE void pair_up(const TileArrays& tiles, const PairKernel& kernel, std::size_t a, Partners& partners,
                        TaskSums& sums) {
  if (partners.size == 0) return;
  partners.close();
  if (kSymmetric && kGradient) partners.clear_gradient();
  const double radius = kernel.scale * kernel.radius;
  const Vector radius2 = hn::Set(kFloats, static_cast<float>(radius * radius));
  const Vector floor = hn::Set(kFloats, kernel.floor);
  std::size_t inside = 0;
  for (std::size_t i = tiles.begin[a]; i < tiles.begin[a + 1]; ++i) {
    const Vector x = hn::Set(kFloats, tiles.offset[0][i]);
    const Vector y = hn::Set(kFloats, tiles.offset[1][i]);
    const Vector z = hn::Set(kFloats, tiles.offset[2][i]);
    const Vector weight = hn::Set(kFloats, tiles.weight[i]);
    Vector sum = hn::Zero(kFloats);
    Vector gradient_x = hn::Zero(kFloats);
    Vector gradient_y = hn::Zero(kFloats);
    Vector gradient_z = hn::Zero(kFloats);
    for (std::size_t k = 0; k < partners.size; k += hn::Lanes(kFloats)) {
      const Vector dx = hn::Sub(x, hn::Load(kFloats, partners.at[0] + k));
      const Vector dy = hn::Sub(y, hn::Load(kFloats, partners.at[1] + k));
      const Vector dz = hn::Sub(z, hn::Load(kFloats, partners.at[2] + k));
      const Vector t = hn::MulAdd(dz, dz, hn::MulAdd(dy, dy, hn::Mul(dx, dx)));
      const auto near = hn::Lt(t, radius2);
      inside += hn::CountTrue(kFloats, near);
      const Vector g = exp2_minus(t);
      const Vector partner = hn::Load(kFloats, partners.weight + k);
      sum = hn::MulAdd(partner, hn::IfThenElseZero(near, hn::Sub(g, floor)), sum);
      if (!kGradient) continue;
      const Vector inner = hn::IfThenElseZero(near, g);
      const Vector to_me = hn::Mul(partner, inner);
      gradient_x = hn::MulAdd(to_me, dx, gradient_x);
      gradient_y = hn::MulAdd(to_me, dy, gradient_y);
      gradient_z = hn::MulAdd(to_me, dz, gradient_z);
      if (!kSymmetric) continue;
      const Vector to_it = hn::Mul(weight, inner);
      float* back_x = partners.gradient[0] + k;
      float* back_y = partners.gradient[1] + k;
      float* back_z = partners.gradient[2] + k;
      hn::Store(hn::NegMulAdd(to_it, dx, hn::Load(kFloats, back_x)), kFloats, back_x);
      hn::Store(hn::NegMulAdd(to_it, dy, hn::Load(kFloats, back_y)), kFloats, back_y);
      hn::Store(hn::NegMulAdd(to_it, dz, hn::Load(kFloats, back_z)), kFloats, back_z);
    }
    sums.kernel += (kSymmetric ? 2.0 : 1.0) * static_cast<double>(tiles.weight[i]) *
                   static_cast<double>(hn::GetLane(hn::SumOfLanes(kFloats, sum)));
    if (!kGradient) continue;
    const std::size_t slot = i - tiles.begin[sums.first_tile];
    sums.gradient[0][slot] += hn::GetLane(hn::SumOfLanes(kFloats, gradient_x));
    sums.gradient[1][slot] += hn::GetLane(hn::SumOfLanes(kFloats, gradient_y));
    sums.gradient[2][slot] += hn::GetLane(hn::SumOfLanes(kFloats, gradient_z));
  }
  if (kSymmetric && kGradient) partners.give_gradient(tiles, sums);
  sums.pairs += (kSymmetric ? 2 : 1) * inside;
  sums.tested += (tiles.begin[a + 1] - tiles.begin[a]) * partners.size;
  partners.size = 0;
  partners.tiles = 0;
}

/// Bit k is set if tile 8 · group + k may have points within the radius of tile a.
HWY_INLINE unsigned tiles_near(const TileArrays& tiles, double radius, std::size_t a, std::size_t group) {
  using Doubles = hn::CappedTag<double, 8>;
  constexpr Doubles kDoubles;
  unsigned bits = 0;
  for (std::size_t k = 0; k < 8; k += hn::Lanes(kDoubles)) {
    const std::size_t b = 8 * group + k;
    auto sum = hn::Zero(kDoubles);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto below =
          hn::Sub(hn::Set(kDoubles, tiles.low[axis][a]), hn::LoadU(kDoubles, tiles.high[axis] + b));
      const auto above =
          hn::Sub(hn::LoadU(kDoubles, tiles.low[axis] + b), hn::Set(kDoubles, tiles.high[axis][a]));
      const auto gap = hn::Max(hn::Zero(kDoubles), hn::Max(below, above));
      sum = hn::MulAdd(gap, gap, sum);
    }
    HWY_ALIGN std::uint8_t mask[8] = {};
    hn::StoreMaskBits(kDoubles, hn::Lt(sum, hn::Set(kDoubles, radius * radius)), mask);
    bits |= static_cast<unsigned>(mask[0]) << k;
  }
  return bits;
}

template <bool kGradient>
HWY_INLINE void add_group_as(const TileArrays& tiles, const PairKernel& kernel, std::size_t group,
                             const std::uint32_t* near, std::size_t near_count, TaskSums& sums) {
  Partners inner;  // tiles of this task, each pair of tiles once
  Partners outer;  // tiles of others, and the tile itself
  const std::size_t end = HWY_MIN(8 * group + 8, tiles.size);
  for (std::size_t a = 8 * group; a < end; ++a) {
    for (std::size_t n = 0; n < near_count; ++n) {
      for (unsigned bits = tiles_near(tiles, kernel.radius, a, near[n]); bits != 0; bits &= bits - 1) {
        const std::size_t b = 8 * near[n] + hwy::Num0BitsBelowLS1Bit_Nonzero32(bits);
        const bool own = b >= sums.first_tile && b < sums.last_tile;
        if (own && b < a) continue;
        Partners& partners = own && b != a ? inner : outer;
        if (partners.full()) {
          if (&partners == &inner)
            pair_up<true, kGradient>(tiles, kernel, a, inner, sums);
          else
            pair_up<false, kGradient>(tiles, kernel, a, outer, sums);
        }
        partners.add(tiles, kernel.scale, b, a);
      }
    }
    pair_up<true, kGradient>(tiles, kernel, a, inner, sums);
    pair_up<false, kGradient>(tiles, kernel, a, outer, sums);
  }
}

void add_group(const TileArrays& tiles, const PairKernel& kernel, std::size_t group,
               const std::uint32_t* near, std::size_t near_count, TaskSums& sums) {
  if (sums.gradient[0] == nullptr) {
    add_group_as<false>(tiles, kernel, group, near, near_count, sums);
  } else {
    add_group_as<true>(tiles, kernel, group, near, near_count, sums);
  }
}

void exp2_minus_all(const float* t, std::size_t n, float* result) {
  for (std::size_t i = 0; i < n; ++i) {
    result[i] = hn::GetLane(exp2_minus(hn::Set(kFloats, t[i])));
  }
}

const char* instruction_set() { return hwy::TargetName(HWY_TARGET); }

}  // namespace crisp::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace crisp::simd {

HWY_EXPORT(add_group);
HWY_EXPORT(exp2_minus_all);
HWY_EXPORT(instruction_set);

void add_group(const TileArrays& tiles, const PairKernel& kernel, std::size_t group,
               const std::uint32_t* near, std::size_t near_count, TaskSums& sums) {
  HWY_DYNAMIC_DISPATCH(add_group)(tiles, kernel, group, near, near_count, sums);
}

void exp2_minus(const float* t, std::size_t n, float* result) {
  HWY_DYNAMIC_DISPATCH(exp2_minus_all)(t, n, result);
}

const char* instruction_set() { return HWY_DYNAMIC_DISPATCH(instruction_set)(); }

}  // namespace crisp::simd
#endif
