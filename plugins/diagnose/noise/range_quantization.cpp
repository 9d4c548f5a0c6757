// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/noise/range_quantization.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "plugins/diagnose/noise/likelihood_gain.hpp"

namespace crisp::diagnose {
namespace {

constexpr double kTelegram = 0.001;         // [m] resolution of the telegram
constexpr double kCell = 0.25 * kTelegram;  // [m] of the histogram
constexpr std::size_t kCells = 1 << 18;     // 65 m

/// |mean of exp(2πi r / step)| at every frequency k / (kCells kCell) up to the Nyquist frequency.
std::vector<double> spectrum_of(std::span<const float> ranges) {
  std::vector<float> histogram(kCells, 0);
  double count = 0;
  for (const float range : ranges) {
    const double bin = std::round(double{range} / kCell);
    if (!(bin >= 0 && bin < double{kCells})) continue;
    histogram[static_cast<std::size_t>(bin)] += 1;
    count += 1;
  }
  std::vector<std::complex<float>> lines;
  Eigen::FFT<float> transform;
  transform.fwd(lines, histogram);
  std::vector<double> sizes;
  for (std::size_t k = 0; k < kCells / 2; ++k)
    sizes.push_back(double{std::abs(lines[k])} / std::max(1.0, count));
  return sizes;
}

double line_at(double frequency, std::span<const float> ranges) {
  std::complex<double> sum = 0;
  for (const float range : ranges) sum += std::polar(1.0, 2 * std::numbers::pi * frequency * double{range});
  return std::abs(sum) / static_cast<double>(ranges.size());
}

/// Refines the frequency of a spectral line between its neighbours (golden-section search).
double top_near(double frequency, double width, std::span<const float> ranges) {
  constexpr int kSteps = 30;
  const double golden = (std::sqrt(5.0) - 1) / 2;
  double low = frequency - width;
  double high = frequency + width;
  for (int step = 0; step < kSteps; ++step) {
    const double a = high - golden * (high - low);
    const double b = low + golden * (high - low);
    if (line_at(a, ranges) > line_at(b, ranges)) {
      high = b;
    } else {
      low = a;
    }
  }
  return (low + high) / 2;
}

/// Whether a range is a multiple of the step, within the telegram's rounding.
bool is_on(double range, double step) {
  return std::abs(range - step * std::round(range / step)) <= kTelegram / 2 * (1 + 1e-3);
}

constexpr double kFinest = 1.5e-3, kCoarsest = 0.05;  // [m]
constexpr std::size_t kMax = 20'000;                  // ranges used to refine the frequency

/// A line in the spectrum of ranges.
struct RangeComb {
  double step = 0;      // [m]
  double strength = 0;  // of the strongest line, 0 to 1
  double tests = 0;     // number of frequencies
};

std::optional<RangeComb> quantization_of(std::span<const float> ranges) {
  constexpr double kWeakest = 0.3;   // strength of a line, 0 to 1
  constexpr double kAsStrong = 0.7;  // relative to the strongest line: a comb has lines at all multiples
  constexpr std::size_t kEnough = 500;
  if (ranges.size() < kEnough) return std::nullopt;
  const auto sizes = spectrum_of(ranges);
  const double apart = 1 / (kCells * kCell);  // [1/m]
  const auto begin = sizes.begin() + static_cast<std::ptrdiff_t>(1 / (kCoarsest * apart));
  const auto end = sizes.begin() + static_cast<std::ptrdiff_t>(1 / (kFinest * apart));
  const double strongest = *std::max_element(begin, end);
  if (strongest < kWeakest) return std::nullopt;
  auto line = std::find_if(begin, end, [&](double size) { return size >= kAsStrong * strongest; });
  while (line + 1 != end && *(line + 1) > *line) ++line;
  const double frequency = top_near(static_cast<double>(line - sizes.begin()) * apart, apart,
                                    ranges.first(std::min(ranges.size(), kMax)));
  return RangeComb{.step = 1 / frequency, .strength = strongest, .tests = static_cast<double>(end - begin)};
}

/// Held-out gain of a comb that was fitted to every other block: log density ratio of the other ranges with
/// and without quantization. The share of ranges off the comb is that of the training blocks. Ranges on the
/// comb lie within the telegram's rounding.
Gain held_out_gain(std::span<const float> ranges, std::span<const std::uint32_t> block, std::uint64_t seed) {
  std::vector<float> fitted;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    if (block[i] % 2 == 0) fitted.push_back(ranges[i]);
  }
  const auto quantization = quantization_of(fitted);
  if (!quantization) return likelihood_gain({}, {}, {}, seed);
  const auto on =
      std::ranges::count_if(fitted, [&](float range) { return is_on(double{range}, quantization->step); });
  const double outlier = 1 - (static_cast<double>(on) + 1) / (static_cast<double>(fitted.size()) + 2);
  const double width = std::min(1.0, kTelegram / quantization->step);
  std::vector<double> after;
  std::vector<std::uint32_t> blocks;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    if (block[i] % 2 == 0) continue;
    after.push_back(std::log(is_on(double{ranges[i]}, quantization->step) ? (1 - outlier) / width
                                                                          : outlier / (1 - width)));
    blocks.push_back(block[i]);
  }
  return likelihood_gain(std::vector<double>(after.size(), 0), after, blocks, seed);
}

}  // namespace

std::optional<Finding> range_quantization(const std::string& scope, std::span<const float> ranges,
                                          std::span<const std::uint32_t> block, std::uint64_t seed) {
  constexpr std::size_t kEnough = 1000;
  if (ranges.size() < kEnough) return std::nullopt;
  const auto quantization = quantization_of(ranges);
  if (!quantization) return std::nullopt;
  const double step = quantization->step;
  const Gain gain = held_out_gain(ranges, block, seed);
  const double count = static_cast<double>(ranges.size());
  double mean = 0;
  double squares = 0;
  for (const float range : ranges) {
    mean += double{range} / count;
    squares += double{range} * double{range} / count;
  }
  // The phase of a line is known to about the telegram's rounding; its slope over the ranges gives the
  // frequency. Ranges are rounded alike where multiples of the step lie alike: more ranges do not help.
  const double rounding = kTelegram / std::sqrt(12.0) * 2 * std::numbers::pi / step;
  const double slope_error = rounding / std::sqrt(std::max(1e-6, squares - mean * mean));
  Finding finding{
      .cause = "noise.quantisation",
      .scope = scope,
      .parameters = {{.name = "step",
                      .unit = "m",
                      .value = step,
                      .std_error = step * step * slope_error / (2 * std::numbers::pi),
                      .free = true}},
      .log10_bayes_factor = (count * (gain.after - gain.before) - std::log(count) / 2) / std::numbers::ln10,
      .p_value = std::min(
          1.0, quantization->tests * std::exp(-count * quantization->strength * quantization->strength)),
      .confounded_with = {},
      .gain = {gain},
      .accepted = gain.significant_increase()};
  return finding;
}

}  // namespace crisp::diagnose
