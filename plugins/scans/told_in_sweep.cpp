// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/scans/told_in_sweep.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>

namespace crisp {
namespace {

constexpr std::size_t kStretch = 6;  // scans …
constexpr std::size_t kUsed = 4;     // … of which so many count
constexpr std::size_t kFewest = 10;  // stretches: of fewer, one draw of signs in a hundred pulls as much
constexpr int kSweepDraws = 4999;

/// How scans pull along one course of their lags.
struct Course {
  std::vector<double> pulls;  ///< by stretch
  double squares = 0;         ///< of what the lags do to all ranges
  double beams = 0;

  double by_chance() const {  ///< mean square of the sum, with random signs
    return std::inner_product(pulls.begin(), pulls.end(), pulls.begin(), 0.0);
  }
  /// The sum, with a sign for each stretch, by its standard deviation.
  double size(const std::vector<double>& signs) const {
    const double sum = std::inner_product(pulls.begin(), pulls.end(), signs.begin(), 0.0);
    return by_chance() > 0 ? std::abs(sum) / std::sqrt(by_chance()) : 0;
  }
};

Course along(const std::vector<ScanPull>& pulls, const std::vector<double>& lags) {
  Course course;
  std::map<std::size_t, double> by_stretch;
  for (const ScanPull& one : pulls) {
    if (one.scan % kStretch >= kUsed) continue;
    double lag = 0;
    for (std::size_t j = 0; j < one.weights.size(); ++j) {
      lag += one.weights[j] * lags[one.scan + j - one.weights.size() / 2];
    }
    by_stretch[one.scan / kStretch] += lag * one.pull;
    course.squares += lag * lag * one.squares;
    course.beams += one.beams;
  }
  for (const auto& [stretch, pull] : by_stretch) course.pulls.push_back(pull);
  return course;
}

LikenessLook look_along(const Course& course, const std::string& covariate) {
  LikenessLook look{.covariate = covariate, .quantity = "range", .unit = "m"};
  const double sum = std::accumulate(course.pulls.begin(), course.pulls.end(), 0.0);
  const double beyond = std::max(0.0, sum * sum - course.by_chance());
  if (course.squares > 0) look.amplitude = std::sqrt(beyond / (course.squares * course.beams));
  return look;
}

/// Chances of the larger of all sizes, whatever the courses have in common.
std::vector<double> chances_of(const std::vector<Course>& courses, std::uint64_t seed) {
  std::vector<double> signs(courses.front().pulls.size(), 1);
  std::vector<double> seen;
  for (const Course& course : courses) seen.push_back(course.size(signs));
  std::vector<double> chances(courses.size(), 1.0 / (kSweepDraws + 1));
  std::mt19937_64 random(seed);
  for (int i = 0; i < kSweepDraws; ++i) {
    for (double& sign : signs) sign = random() % 2 == 0 ? 1 : -1;
    double largest = 0;
    for (const Course& course : courses) largest = std::max(largest, course.size(signs));
    for (std::size_t k = 0; k < courses.size(); ++k) {
      if (largest >= seen[k]) chances[k] += 1.0 / (kSweepDraws + 1);
    }
  }
  return chances;
}

}  // namespace

std::optional<Likeness> told_in_sweep(const std::vector<SeriesScan>& scans,
                                      const std::vector<ScanPull>& pulls, const std::vector<double>& delays,
                                      std::uint64_t seed) {
  std::vector<double> by_turns;
  for (const SeriesScan& scan : scans) by_turns.push_back(scan.count % 2 == 0 ? 1 : -1);
  const std::vector<Course> courses = {along(pulls, delays), along(pulls, by_turns)};
  if (courses.front().pulls.size() < kFewest) return {};
  const auto chances = chances_of(courses, seed);
  Likeness told{.looks = {look_along(courses[0], "receipt less stamp"),
                          look_along(courses[1], "count of scans modulo 2")}};
  for (std::size_t k = 0; k < chances.size(); ++k) {
    told.looks[k].p_value = std::min(1.0, chances[k]);
    told.p_value = std::min(told.p_value, told.looks[k].p_value);
  }
  return told;
}

}  // namespace crisp
