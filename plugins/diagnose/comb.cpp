// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/comb.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "plugins/diagnose/likelihood_gain.hpp"

namespace crisp {
namespace {

constexpr double kTelegram = 0.001;         // [m] a whole number of these is no news
constexpr double kCell = 0.25 * kTelegram;  // [m] of the histogram
constexpr std::size_t kCells = 1 << 18;     // 65 m

/// |mean of exp(2πi r / step)|, for every frequency k / (kCells kCell) up to the half of all.
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

/// The frequency of the line's top, between its neighbours in the spectrum (golden section).
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

/// ln of a range's density over that without a comb: nearly all lie within half a telegram's unit of it.
double log_density_ratio(double range, double step) {
  constexpr double kStray = 0.01;
  const double width = std::min(1.0, kTelegram / step);
  const double off = std::abs(range - step * std::round(range / step));
  return std::log(off <= kTelegram / 2 * (1 + 1e-3) ? (1 - kStray) / width : kStray / (1 - width));
}

}  // namespace

std::optional<Finding> quantisation(const std::string& scope, std::span<const float> ranges,
                                    std::span<const std::uint32_t> block, std::uint64_t seed) {
  constexpr double kFinest = 1.5e-3, kCoarsest = 0.05;  // [m]
  constexpr double kWeakest = 0.3;                      // line, of 1
  constexpr double kAsStrong = 0.7;                     // of the strongest: a comb has lines at all multiples
  constexpr std::size_t kEnough = 1000;
  constexpr std::size_t kMost = 20'000;  // to find the top by
  if (ranges.size() < kEnough) return std::nullopt;
  const auto sizes = spectrum_of(ranges);
  const double apart = 1 / (kCells * kCell);  // [1/m]
  const auto first = static_cast<std::ptrdiff_t>(1 / (kCoarsest * apart));
  const auto last = static_cast<std::ptrdiff_t>(1 / (kFinest * apart));
  const auto begin = sizes.begin() + first;
  const auto end = sizes.begin() + last;
  const double strongest = *std::max_element(begin, end);
  if (strongest < kWeakest) return std::nullopt;
  auto line = std::find_if(begin, end, [&](double size) { return size >= kAsStrong * strongest; });
  while (line + 1 != end && *(line + 1) > *line) ++line;
  const double frequency = top_near(static_cast<double>(line - sizes.begin()) * apart, apart,
                                    ranges.first(std::min(ranges.size(), kMost)));
  const double step = 1 / frequency;
  std::vector<double> before;
  std::vector<double> after;
  double mean = 0;
  double squares = 0;
  double likelihood = 0;
  for (const float range : ranges) {
    before.push_back(0);
    after.push_back(log_density_ratio(double{range}, step));
    likelihood += after.back();
    mean += double{range} / static_cast<double>(ranges.size());
    squares += double{range} * double{range} / static_cast<double>(ranges.size());
  }
  const Gain gain = likelihood_gain(before, after, {block.begin(), block.end()}, seed);
  // The phase of a line is known to about the telegram's rounding; its slope over the ranges is the
  // frequency.
  const double rounding = kTelegram / std::sqrt(12.0) * 2 * std::numbers::pi * frequency;
  const double slope_error = rounding / std::sqrt(static_cast<double>(std::min(ranges.size(), kMost)) *
                                                  std::max(1e-6, squares - mean * mean));
  const double count = static_cast<double>(ranges.size());
  Finding finding{
      .cause = "noise.quantisation",
      .scope = scope,
      .parameters = {{.name = "step",
                      .unit = "m",
                      .value = step,
                      .std_error = step * step * slope_error / (2 * std::numbers::pi),
                      .free = true}},
      .log10_odds = (likelihood - std::log(count) / 2) / std::numbers::ln10,
      .p_value = std::min(1.0, static_cast<double>(last - first) * std::exp(-count * strongest * strongest)),
      .confounded_with = {},
      .gain = {gain},
      .accepted = gain.surely_rises()};
  return finding;
}

}  // namespace crisp
