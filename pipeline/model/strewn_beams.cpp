// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/model/strewn_beams.hpp"

namespace crisp {

StrewnBeams::StrewnBeams(std::span<const simd::BareLaser> lasers, const PlateTrajectory& plate)
    : lasers_(lasers), plate_(plate) {}

void StrewnBeams::add(const Measurements& beams, std::size_t i) {
  const std::size_t laser = beams.laser[i];
  const simd::BareLaser& own = lasers_[laser];
  const double time = beams.time[i] + own.eta;
  if (plates_.empty()) plates_.assign(lasers_.size(), PlateTrajectory::Cursor(plate_));
  const auto arc = plates_[laser].arc(time);
  if (!arc) return;
  if (beams_.empty()) {  // only where there are such beams at all
    beams_.resize(kFields);
    points_.resize(kPointFields);
    range_.resize(kSize);
    mirror_.resize(kSize);
  }
  const std::size_t k = index_.size();
  range_[k] = beams.range[i];
  mirror_[k] = beams.mirror_angle[i];
  const std::array<double, kFields> fields = {time,
                                              arc->begin,
                                              1 / arc->width,
                                              arc->coefficients[0],
                                              arc->coefficients[1],
                                              arc->coefficients[2],
                                              arc->coefficients[3],
                                              own.lambda,
                                              own.tau,
                                              own.cos_alpha,
                                              own.sin_alpha};
  for (std::size_t f = 0; f < kFields; ++f) beams_[f][k] = fields[f];
  index_.push_back(static_cast<std::uint32_t>(i));
}

void StrewnBeams::place() {
  if (index_.empty()) return;
  const auto of = [this](std::size_t field) { return beams_[field].data(); };
  simd::place_strewn({.range = range_.data(),
                      .mirror = mirror_.data(),
                      .time = of(kTime),
                      .begin = of(kBegin),
                      .inverse = of(kInverse),
                      .coefficients = {of(kCoefficients), of(kCoefficients + 1), of(kCoefficients + 2),
                                       of(kCoefficients + 3)},
                      .lambda = of(kLambda),
                      .tau = of(kTau),
                      .cos_alpha = of(kCosAlpha),
                      .sin_alpha = of(kSinAlpha),
                      .size = index_.size()},
                     {.x = points_[kX].data(),
                      .y = points_[kY].data(),
                      .z = points_[kZ].data(),
                      .cosine = points_[kCosine].data(),
                      .sine = points_[kSine].data(),
                      .rate = points_[kRate].data()});
}

}  // namespace crisp
