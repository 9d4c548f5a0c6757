// SPDX-License-Identifier: BSD-3-Clause
// Compiled once per instruction set and dispatched at run time (Google Highway).
#include "plugins/diagnose/noise/normal_mixture.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "plugins/diagnose/noise/normal_mixture.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace crisp::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class Tag>
HWY_INLINE void expect_some(Tag tag, const diagnose::MixtureBlock& block, std::size_t k) {
  constexpr double kOneBySqrtTwoPi = 0.3989422804014327;
  const auto value = hn::LoadU(tag, block.value + k);
  const auto deviation = hn::LoadU(tag, block.deviation + k);
  const auto half = hn::Set(tag, -0.5);
  auto total = hn::Set(tag, 1e-300);
  hn::Vec<Tag> density[diagnose::MixtureBlock::kMaxComponents];
  for (std::size_t c = 0; c < block.components; ++c) {
    const auto& component = block.component[c];
    const auto spread = hn::Mul(deviation, hn::Set(tag, component.scale));
    const auto z = hn::Div(hn::Sub(value, hn::LoadU(tag, component.mean + k)), spread);
    const auto bell = hn::Exp(tag, hn::Mul(half, hn::Mul(z, z)));
    density[c] = hn::Div(
        hn::Mul(hn::Mul(hn::LoadU(tag, component.share + k), bell), hn::Set(tag, kOneBySqrtTwoPi)), spread);
    total = hn::Add(total, density[c]);
  }
  for (std::size_t c = 0; c < block.components; ++c) {
    hn::StoreU(hn::Div(density[c], total), tag, block.component[c].probability + k);
  }
  hn::StoreU(hn::Log(tag, total), tag, block.log_density + k);
}

void expect(const diagnose::MixtureBlock& block) {
  const hn::ScalableTag<double> many;
  const hn::CappedTag<double, 1> one;
  std::size_t k = 0;
  for (; k + hn::Lanes(many) <= block.size; k += hn::Lanes(many)) expect_some(many, block, k);
  for (; k < block.size; ++k) expect_some(one, block, k);
}

}  // namespace crisp::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace crisp::simd {

HWY_EXPORT(expect);

void expect(const diagnose::MixtureBlock& block) { HWY_DYNAMIC_DISPATCH(expect)(block); }

}  // namespace crisp::simd
#endif
