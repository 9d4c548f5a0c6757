// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/scans/sweep_fit_test.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "pipeline/statistics/random_stream.hpp"

namespace crisp::diagnose {
namespace {

constexpr std::size_t kStretch = 6;  // scans per block …
constexpr std::size_t kUsed = 4;     // … of which this many are used
constexpr std::size_t kMin = 10;     // blocks: with fewer, p < 1 % is hardly attainable
constexpr int kSweepDraws = 4999;

/// Score of one pattern of lags, by block.
struct Course {
  std::vector<double> scores;  ///< by block
  double squares = 0;          ///< squared effect of the lags on all ranges
  double beams = 0;

  double by_chance() const {  ///< expected square of the sum under random signs
    return std::inner_product(scores.begin(), scores.end(), scores.begin(), 0.0);
  }
  /// Sum with a sign per block, in units of its standard deviation.
  double size(const std::vector<double>& signs) const {
    const double sum = std::inner_product(scores.begin(), scores.end(), signs.begin(), 0.0);
    return by_chance() > 0 ? std::abs(sum) / std::sqrt(by_chance()) : 0;
  }
};

Course along(const std::vector<ScanScore>& scores, const std::vector<double>& lags) {
  Course course;
  std::map<std::size_t, double> by_stretch;
  for (const ScanScore& one : scores) {
    if (one.scan % kStretch >= kUsed) continue;
    double lag = 0;
    for (std::size_t j = 0; j < one.weights.size(); ++j) {
      lag += one.weights[j] * lags[one.scan + j - one.weights.size() / 2];
    }
    by_stretch[one.scan / kStretch] += lag * one.score;
    course.squares += lag * lag * one.squares;
    course.beams += one.beams;
  }
  for (const auto& [stretch, score] : by_stretch) course.scores.push_back(score);
  return course;
}

data::FitTest look_along(const Course& course, const std::string& covariate) {
  data::FitTest test{.covariate = covariate, .quantity = "range", .unit = "m"};
  const double sum = std::accumulate(course.scores.begin(), course.scores.end(), 0.0);
  const double beyond = std::max(0.0, sum * sum - course.by_chance());
  if (course.squares > 0) test.amplitude = std::sqrt(beyond / (course.squares * course.beams));
  return test;
}

/// p-values for the maximum over all patterns (max-T correction), whatever their correlation.
std::vector<double> chances_of(const std::vector<Course>& courses, std::uint64_t seed) {
  std::vector<double> signs(courses.front().scores.size(), 1);
  std::vector<double> seen;
  for (const Course& course : courses) seen.push_back(course.size(signs));
  std::vector<double> chances(courses.size(), 1.0 / (kSweepDraws + 1));
  statistics::RandomStream random(seed, "signs");
  for (int i = 0; i < kSweepDraws; ++i) {
    for (double& sign : signs) sign = random.sign();
    double largest = 0;
    for (const Course& course : courses) largest = std::max(largest, course.size(signs));
    for (std::size_t k = 0; k < courses.size(); ++k) {
      if (largest >= seen[k]) chances[k] += 1.0 / (kSweepDraws + 1);
    }
  }
  return chances;
}

}  // namespace

std::optional<data::FitStatistics> sweep_fit_test(const std::vector<SeriesScan>& scans,
                                                  const std::vector<ScanScore>& scores,
                                                  const std::vector<double>& delays, std::uint64_t seed) {
  std::vector<double> by_turns;
  for (const SeriesScan& scan : scans) by_turns.push_back(scan.count % 2 == 0 ? 1 : -1);
  const std::vector<Course> courses = {along(scores, delays), along(scores, by_turns)};
  if (courses.front().scores.size() < kMin) return {};
  const auto chances = chances_of(courses, seed);
  data::FitStatistics reported{.tests = {look_along(courses[0], "receipt less stamp"),
                                         look_along(courses[1], "count of scans modulo 2")}};
  for (std::size_t k = 0; k < chances.size(); ++k) {
    reported.tests[k].p_value = std::min(1.0, chances[k]);
    reported.p_value = std::min(reported.p_value, reported.tests[k].p_value);
  }
  return reported;
}

}  // namespace crisp::diagnose
