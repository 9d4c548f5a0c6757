// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/model/mixed_batch.hpp"

namespace crisp::model {

MixedBeams::MixedBeams(std::span<const simd::BareLaser> lasers, const PlateTrajectory& plate)
    : lasers_(lasers), plate_(plate) {}

void MixedBeams::add(const Measurements& beams, std::size_t begin, std::size_t end) {
  std::size_t k = size_;
  for (std::size_t i = begin; i < end; ++i) {
    const simd::BareLaser& own = lasers_[beams.laser[i]];
    const double time = beams.time[i] + own.eta;
    const auto interval = plate_.interval(time);
    if (!interval) continue;
    index_[k] = static_cast<std::uint32_t>(i);
    interval_[k] = static_cast<std::int64_t>(*interval);
    range_[k] = beams.range[i];
    mirror_[k] = beams.mirror_angle[i];
    beams_[kTime][k] = time;
    beams_[kLambda][k] = own.lambda;
    beams_[kTau][k] = own.tau;
    beams_[kCosAlpha][k] = own.cos_alpha;
    beams_[kSinAlpha][k] = own.sin_alpha;
    ++k;
  }
  size_ = k;
}

void MixedBeams::place() {
  if (size_ == 0) return;
  simd::place_mixed(
      {.range = range_,
       .mirror = mirror_,
       .time = beams_[kTime],
       .interval = interval_.data(),
       .lambda = beams_[kLambda],
       .tau = beams_[kTau],
       .cos_alpha = beams_[kCosAlpha],
       .sin_alpha = beams_[kSinAlpha],
       .size = size_},
      {.times = plate_.times().data(), .angles = plate_.angles().data(), .rates = plate_.rates().data()},
      {.x = points_[kX],
       .y = points_[kY],
       .z = points_[kZ],
       .cosine = points_[kCosine],
       .sine = points_[kSine],
       .rate = points_[kRate]});
}

}  // namespace crisp::model
