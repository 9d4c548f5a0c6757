// SPDX-License-Identifier: BSD-3-Clause
// Compiled once for each instruction set, and chosen from when the program runs (Google Highway).
#include "pipeline/model/simd_placement.hpp"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pipeline/model/simd_placement.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace crisp::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::CappedTag<double, kBeyond>;
using Vector = hn::Vec<Doubles>;
constexpr Doubles kDoubles;
constexpr hn::Rebind<float, Doubles> kFloats;

struct SineCosine {
  Vector sine;
  Vector cosine;
};

HWY_INLINE Vector constant(double value) { return hn::Set(kDoubles, value); }

/// Taylor's series of sin r / r in r², for |r| ≤ π/4: the first term left out is r¹⁶/17! < 6e-17.
HWY_INLINE Vector sine_series(Vector r2) {
  Vector p = constant(-1.0 / 1307674368000);  // 15!
  p = hn::MulAdd(p, r2, constant(1.0 / 6227020800));
  p = hn::MulAdd(p, r2, constant(-1.0 / 39916800));
  p = hn::MulAdd(p, r2, constant(1.0 / 362880));
  p = hn::MulAdd(p, r2, constant(-1.0 / 5040));
  p = hn::MulAdd(p, r2, constant(1.0 / 120));
  p = hn::MulAdd(p, r2, constant(-1.0 / 6));
  return hn::MulAdd(p, r2, constant(1));
}

/// Taylor's series of cos r in r², for |r| ≤ π/4: the first term left out is r¹⁸/18! < 3e-18.
HWY_INLINE Vector cosine_series(Vector r2) {
  Vector p = constant(1.0 / 20922789888000);  // 16!
  p = hn::MulAdd(p, r2, constant(-1.0 / 87178291200));
  p = hn::MulAdd(p, r2, constant(1.0 / 479001600));
  p = hn::MulAdd(p, r2, constant(-1.0 / 3628800));
  p = hn::MulAdd(p, r2, constant(1.0 / 40320));
  p = hn::MulAdd(p, r2, constant(-1.0 / 720));
  p = hn::MulAdd(p, r2, constant(1.0 / 24));
  p = hn::MulAdd(p, r2, constant(-0.5));
  return hn::MulAdd(p, r2, constant(1));
}

/// Both are right to 4e-16 up to 1.6e6 rad, where a plate is after three days of a turn a second; beyond, to
/// what an angle so large is itself rounded by. At 100 m the first is 4e-14 m.
HWY_INLINE SineCosine sine_cosine_of(Vector angle) {
  const hn::RebindToUnsigned<Doubles> integers;
  const Vector magic = constant(6755399441055744.0);  // 1.5 · 2⁵²: adding it rounds to whole numbers
  const Vector shifted = hn::MulAdd(angle, constant(0.63661977236758134308), magic);  // 2/π
  const Vector quarters = hn::Sub(shifted, magic);
  // π/2 in two parts, of which the first has 33 bits, so that its multiples are exact
  Vector r = hn::NegMulAdd(quarters, constant(0x1.921fb544p+0), angle);
  r = hn::NegMulAdd(quarters, constant(0x1.0b4611a626331p-34), r);
  const Vector r2 = hn::Mul(r, r);
  const Vector s = hn::Mul(r, sine_series(r2));
  const Vector c = cosine_series(r2);

  const auto one = hn::Set(integers, 1);
  const auto quadrant = hn::BitCast(integers, shifted);
  const auto odd = hn::RebindMask(kDoubles, hn::TestBit(quadrant, one));
  const auto sign = hn::SignBit(kDoubles);
  const auto sine_sign = hn::And(sign, hn::BitCast(kDoubles, hn::ShiftLeft<62>(quadrant)));
  const auto cosine_sign = hn::And(sign, hn::BitCast(kDoubles, hn::ShiftLeft<62>(hn::Add(quadrant, one))));
  return {hn::Xor(hn::IfThenElse(odd, c, s), sine_sign), hn::Xor(hn::IfThenElse(odd, s, c), cosine_sign)};
}

HWY_INLINE Vector along_arc(Vector u, Vector c0, Vector c1, Vector c2, Vector c3) {
  return hn::MulAdd(u, hn::MulAdd(u, hn::MulAdd(u, c3, c2), c1), c0);
}

struct Position {
  Vector x, y, z;
};

/// Equation (2) for a vector of beams.
HWY_INLINE Position position_of(Vector range, const SineCosine& mirror, const SineCosine& plate, Vector tau,
                                Vector cos_alpha, Vector sin_alpha) {
  const Vector aside = hn::Mul(range, mirror.sine);
  const Vector outwards = hn::NegMulAdd(sin_alpha, aside, tau);
  const Vector onwards = hn::Mul(cos_alpha, aside);
  return {hn::MulSub(plate.cosine, outwards, hn::Mul(plate.sine, onwards)),
          hn::MulAdd(plate.sine, outwards, hn::Mul(plate.cosine, onwards)),
          hn::Neg(hn::Mul(range, mirror.cosine))};
}

HWY_INLINE Vector promoted(const float* values) {
  return hn::PromoteTo(kDoubles, hn::LoadU(kFloats, values));
}

/// Sine and cosine of a vector of mirror angles: cached where the angles have not changed.
HWY_INLINE SineCosine mirror_of(const BareBeams& beams, std::size_t i, const MirrorTable& known) {
  const std::size_t first = beams.beam[i];
  const std::size_t end = first + hn::Lanes(kDoubles);
  const auto angle = hn::LoadU(kFloats, beams.mirror + i);
  const bool has_place = beams.beam[i + hn::Lanes(kDoubles) - 1] + std::size_t{1} == end && end <= known.size;
  if (has_place && hn::AllTrue(kFloats, hn::Eq(angle, hn::LoadU(kFloats, known.angle + first)))) {
    return {hn::LoadU(kDoubles, known.sine + first), hn::LoadU(kDoubles, known.cosine + first)};
  }
  const SineCosine mirror = sine_cosine_of(hn::PromoteTo(kDoubles, angle));
  if (has_place) {
    hn::StoreU(angle, kFloats, known.angle + first);
    hn::StoreU(mirror.sine, kDoubles, known.sine + first);
    hn::StoreU(mirror.cosine, kDoubles, known.cosine + first);
  }
  return mirror;
}

/// Places whole vectors of beams, until one was not fired along the arc.
HWY_INLINE std::size_t place_vectors(const BareBeams& beams, const BareLaser& laser, const PlateArc& arc,
                                     const MirrorTable& mirrors, double* x, double* y, double* z) {
  const auto& c = arc.coefficients;
  const Vector begin = constant(arc.begin);
  const Vector end = constant(arc.end);
  const Vector per_width = constant(1 / arc.width);
  const Vector cos_alpha = constant(laser.cos_alpha);
  const Vector sin_alpha = constant(laser.sin_alpha);
  const Vector tau = constant(laser.tau);
  for (std::size_t i = 0; i < beams.size; i += hn::Lanes(kDoubles)) {
    const Vector time = hn::Add(hn::LoadU(kDoubles, beams.time + i), constant(laser.eta));
    const auto along = hn::And(hn::Ge(time, begin), hn::Le(time, end));

    const Vector u = hn::Mul(hn::Sub(time, begin), per_width);
    const Vector phi = along_arc(u, constant(c[0]), constant(c[1]), constant(c[2]), constant(c[3]));
    const SineCosine plate = sine_cosine_of(hn::Add(phi, constant(laser.lambda)));
    const Position at = position_of(promoted(beams.range + i), mirror_of(beams, i, mirrors), plate, tau,
                                    cos_alpha, sin_alpha);
    hn::StoreU(at.x, kDoubles, x + i);
    hn::StoreU(at.y, kDoubles, y + i);
    hn::StoreU(at.z, kDoubles, z + i);

    if (!hn::AllTrue(kDoubles, along)) {
      return i + static_cast<std::size_t>(hn::FindFirstTrue(kDoubles, hn::Not(along)));
    }
  }
  return beams.size;
}

std::size_t place_bare(const BareBeams& beams, const BareLaser& laser, const PlateArc& arc,
                       const MirrorTable& mirrors, double* x, double* y, double* z) {
  const std::size_t rest = beams.size % hn::Lanes(kDoubles);
  BareBeams part = beams;
  part.size -= rest;
  const std::size_t placed = place_vectors(part, laser, arc, mirrors, x, y, z);
  if (placed < part.size || rest == 0) return placed;

  // the last beams, filled up to a vector
  float range[kBeyond] = {};
  float mirror[kBeyond] = {};
  double time[kBeyond] = {};
  const std::uint16_t beam[kBeyond] = {};  // not in a row: they have no place in the table
  std::copy_n(beams.range + placed, rest, range);
  std::copy_n(beams.mirror + placed, rest, mirror);
  std::copy_n(beams.time + placed, rest, time);
  part = {.range = range, .mirror = mirror, .time = time, .beam = beam, .size = hn::Lanes(kDoubles)};
  return placed + HWY_MIN(rest, place_vectors(part, laser, arc, mirrors, x + placed, y + placed, z + placed));
}

void place_mixed(const MixedArrays& beams, const PlateReadings& plate, const MixedPoints& points) {
  constexpr hn::RebindToSigned<Doubles> kIntegers;
  for (std::size_t i = 0; i < beams.size; i += hn::Lanes(kDoubles)) {
    const auto at = [i](const double* values) { return hn::LoadU(kDoubles, values + i); };
    const auto interval = hn::LoadU(kIntegers, beams.interval + i);
    const auto of = [&](const double* readings) { return hn::GatherIndex(kDoubles, readings, interval); };
    // as PlateTrajectory::arc()
    const Vector begin = of(plate.times);
    const Vector width = hn::Sub(of(plate.times + 1), begin);
    const Vector angle = of(plate.angles);
    const Vector rise = hn::Sub(of(plate.angles + 1), angle);
    const Vector c1 = hn::Mul(of(plate.rates), width);
    const Vector m1 = hn::Mul(of(plate.rates + 1), width);
    const Vector c2 = hn::Sub(hn::Sub(hn::Mul(constant(3), rise), hn::Add(c1, c1)), m1);
    const Vector c3 = hn::Sub(hn::Add(c1, m1), hn::Add(rise, rise));
    const Vector inverse = hn::Div(constant(1), width);
    const Vector u = hn::Mul(hn::Sub(at(beams.time), begin), inverse);
    const Vector phi = along_arc(u, angle, c1, c2, c3);
    const Vector slope = hn::MulAdd(u, hn::MulAdd(hn::Mul(constant(3), u), c3, hn::Add(c2, c2)), c1);
    const SineCosine azimuth = sine_cosine_of(hn::Add(phi, at(beams.lambda)));
    const Position point = position_of(promoted(beams.range + i), sine_cosine_of(promoted(beams.mirror + i)),
                                       azimuth, at(beams.tau), at(beams.cos_alpha), at(beams.sin_alpha));
    hn::StoreU(point.x, kDoubles, points.x + i);
    hn::StoreU(point.y, kDoubles, points.y + i);
    hn::StoreU(point.z, kDoubles, points.z + i);
    hn::StoreU(azimuth.cosine, kDoubles, points.cosine + i);
    hn::StoreU(azimuth.sine, kDoubles, points.sine + i);
    hn::StoreU(hn::Mul(slope, inverse), kDoubles, points.rate + i);
  }
}

void sine_cosine(const double* angle, std::size_t n, double* sine, double* cosine) {
  for (std::size_t i = 0; i < n; ++i) {
    const SineCosine both = sine_cosine_of(constant(angle[i]));
    sine[i] = hn::GetLane(both.sine);
    cosine[i] = hn::GetLane(both.cosine);
  }
}

}  // namespace crisp::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace crisp::simd {

HWY_EXPORT(place_bare);
HWY_EXPORT(place_mixed);
HWY_EXPORT(sine_cosine);

std::size_t place_bare(const BareBeams& beams, const BareLaser& laser, const PlateArc& arc,
                       const MirrorTable& mirrors, double* x, double* y, double* z) {
  return HWY_DYNAMIC_DISPATCH(place_bare)(beams, laser, arc, mirrors, x, y, z);
}

void place_mixed(const MixedArrays& beams, const PlateReadings& plate, const MixedPoints& points) {
  HWY_DYNAMIC_DISPATCH(place_mixed)(beams, plate, points);
}

void sine_cosine(const double* angle, std::size_t n, double* sine, double* cosine) {
  HWY_DYNAMIC_DISPATCH(sine_cosine)(angle, n, sine, cosine);
}

}  // namespace crisp::simd
#endif
