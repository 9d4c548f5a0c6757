// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/encoder_quantization.hpp"

#include <algorithm>
#include <cmath>

namespace crisp::estimate {
namespace {

constexpr double kMemory = 0.2;  // [s] beyond which readings of the encoder share no error: kEncoderSmoothing

/// [1/s] How many beams were fired in a second.
double beams_a_second(const Sample& sample) {
  const auto [first, last] = std::ranges::minmax(sample.beams.time);
  return static_cast<double>(sample.beams.size()) / std::max(last - first, kMemory);
}

}  // namespace

std::vector<float> noise_with_quantization(const quality::Surfels& surfels, const quality::BeamsView& beams,
                                           const Sample& sample, double step, double noise) {
  std::vector<float> with_steps(beams.points.size());
  for (std::size_t i = 0; i < with_steps.size(); ++i) with_steps[i] = static_cast<float>(beams.noise_of(i));
  if (sample.beams.size() == 0) return with_steps;
  const double a_second = beams_a_second(sample);
  const double error = step / std::sqrt(12);
  for (const quality::Surfel& surfel : surfels.surfels) {
    for (std::uint32_t k = surfel.begin; k < surfel.end; ++k) {
      const std::uint32_t i = surfels.members[k];
      const auto plate = sample.plate->at(sample.beams.time[i]);
      const double rate = plate ? std::abs(plate->rate) : 0;
      const double sharing = a_second * (rate * kMemory > step ? step / rate : kMemory);
      const double by_angle = surfel.normal.y() * beams.points.x[i] - surfel.normal.x() * beams.points.y[i];
      const double relative = by_angle * error / (noise * with_steps[i]);
      with_steps[i] *= static_cast<float>(std::sqrt(1 + std::max(1.0, sharing) * relative * relative));
    }
  }
  return with_steps;
}

}  // namespace crisp::estimate
