// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/encoder_error_blocks.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/estimate/base_parameters.hpp"

namespace crisp::estimate {
namespace {

/// [s] of each beam by the plate's clock.
std::vector<double> plate_times(const SensorModel& model, const Measurements& beams) {
  std::vector<double> times = beams.time;
  for (std::size_t i = 0; i < times.size(); ++i) {
    times[i] += model.values()[static_cast<Eigen::Index>(slot(model, beams.laser[i], kEta))];
  }
  return times;
}

}  // namespace

double variance_of_mean_reading(std::span<const double> angles, double step) {
  double sum = 0;
  for (const double a : angles) {
    for (const double b : angles) {
      const double steps = (b - a) / step;
      const double fraction = steps - std::floor(steps);
      sum += 1.0 / 12 - fraction * (1 - fraction) / 2;
    }
  }
  // Where errors cancel but for rounding, at least the resolution of the mean of so many numbers.
  const auto n = static_cast<double>(angles.size());
  return step * step * std::max(sum, 1.0 / 12) / (n * n);
}

EncoderErrorBlocks encoder_error_blocks(const SensorModel& model, const Sample& sample, double step) {
  constexpr double kLong = 0.05;  // [s]
  const std::vector<double> times = plate_times(model, sample.beams);
  const double first = std::ranges::min(times);
  EncoderErrorBlocks result;
  for (const double time : times) {
    result.of_beam.push_back(static_cast<std::uint32_t>((time - first) / kLong));
  }
  const auto read = sample.plate->times();
  const auto angles = sample.plate->angles();
  const std::size_t moments = std::ranges::max(result.of_beam) + std::size_t{1};
  for (std::size_t moment = 0; moment < moments; ++moment) {
    const auto reading_at = [&](double time) {
      return static_cast<std::size_t>(std::ranges::lower_bound(read, time) - read.begin());
    };
    const double begin = first + kLong * static_cast<double>(moment);
    // Slow encoders read less than once in a moment: then the next one stands for it.
    const std::size_t from = std::min(reading_at(begin), angles.size() - 1);
    const std::size_t to = std::max(reading_at(begin + kLong), from + 1);
    result.variances.push_back(variance_of_mean_reading(angles.subspan(from, to - from), step));
  }
  return result;
}

}  // namespace crisp::estimate
