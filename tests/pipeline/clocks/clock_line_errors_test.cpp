// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "pipeline/clocks/clock_line.hpp"
#include "tests/support/simulated_stamps.hpp"

namespace crisp {
namespace {

using namespace crisp::clocks;
using namespace test;  // NOLINT(google-build-using-namespace)

struct Distribution {
  const char* name;
  Delays delays;
};

class ErrorsOfLine : public ::testing::TestWithParam<Distribution> {};

// Intervals must have at least their nominal coverage, without being uninformatively wide.
// With 400 seeds a coverage of 0.68 has a standard deviation of 0.023, one of 0.95 of 0.011: three are
// allowed.
TEST_P(ErrorsOfLine, HaveTheirNominalCoverageOfTheTrueSkew) {
  constexpr int kSeeds = 400;
  constexpr double kSkew = 123e-6;
  int in_one = 0;
  int in_two = 0;
  double squared_error = 0;
  double squared_estimate = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const auto stamps = simulated_stamps(static_cast<std::uint64_t>(seed), 20, 50, kSkew, GetParam().delays);
    const auto line = line_by_convex_hull(stamps, mean_device_time(stamps));
    const double claim = errors_of_line(stamps, line).slope;
    const double error = std::abs(line.slope - kSkew);
    in_one += error <= claim;
    in_two += error <= 2 * claim;
    squared_error += error * error / kSeeds;
    squared_estimate += claim * claim / kSeeds;
  }
  EXPECT_GE(in_one, (0.683 - 3 * 0.023) * kSeeds);
  EXPECT_GE(in_two, (0.95 - 3 * 0.011) * kSeeds);
  EXPECT_LE(std::sqrt(squared_estimate), 3 * std::sqrt(squared_error));
}

INSTANTIATE_TEST_SUITE_P(Distributions, ErrorsOfLine,
                         ::testing::Values(Distribution{"exponential", exponential_delays(3e-4)},
                                           Distribution{"gamma2", gamma_delays(2, 2e-4)},
                                           Distribution{"gamma8", gamma_delays(8, 1e-4)},
                                           Distribution{"bursts", bursty_delays(3e-4, 5e-3, 30, 0.002)}),
                         [](const auto& law) { return std::string(law.param.name); });

// The line lies above the clock by the unavoidable delay. The residual after its correction has at least its
// nominal coverage where delays are as likely down to the least one or more so; where they thin out (gamma2)
// their distribution is known less well: nine in ten. For delays none of which is near the least one (gamma8)
// two fifths are corrected.
class BiasOfLine : public ErrorsOfLine {};

TEST_P(BiasOfLine, IsTakenOut) {
  constexpr int kSeeds = 400;
  double late = 0;
  double left = 0;
  double squared_before = 0;
  double squared_after = 0;
  int in_two = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const auto stamps = simulated_stamps(static_cast<std::uint64_t>(seed), 10, 50, 0, GetParam().delays);
    const auto line = line_by_convex_hull(stamps, mean_device_time(stamps));
    const LineErrors errors = errors_of_line(stamps, line);
    const double before = line.at_center;
    late += before / kSeeds;
    left += (before - errors.bias) / kSeeds;
    squared_before += before * before / kSeeds;
    squared_after += (before - errors.bias) * (before - errors.bias) / kSeeds;
    in_two += std::abs(before - errors.bias) <= 2 * errors.at_center;
  }
  EXPECT_LT(std::abs(left), 0.35 * late);
  EXPECT_LT(squared_after, squared_before);
  EXPECT_GE(in_two, 0.87 * kSeeds);
}

INSTANTIATE_TEST_SUITE_P(Distributions, BiasOfLine,
                         ::testing::Values(Distribution{"exponential", exponential_delays(3e-4)},
                                           Distribution{"gamma2", gamma_delays(2, 2e-4)},
                                           Distribution{"bursts", bursty_delays(3e-4, 5e-3, 30, 0.002)}),
                         [](const auto& law) { return std::string(law.param.name); });

TEST(ErrorsOfLine, AFewStampsThatAreFasterThanAllOthersAreTheLeast) {
  std::vector<Stamp> stamps;
  for (int i = 0; i < 500; ++i) stamps.push_back({0.02 * i, 60e-6 + 1e-7 * ((i * 7919) % 97)});
  for (const int fast : {20, 210, 300, 470}) stamps[static_cast<std::size_t>(fast)].lead = 1e-6 * (fast % 4);
  const auto errors = errors_of_line(stamps, line_by_convex_hull(stamps, 5));
  EXPECT_LT(errors.bias, 12e-6);
  EXPECT_GT(errors.at_center, 10e-6);  // or they are not: the others are 60 us later
}

TEST(ErrorsOfLine, AreWideWhereThereAreOnlyTwoStamps) {
  const std::vector<Stamp> stamps = {{0, 0}, {1, 1e-4}};
  const auto line = line_by_convex_hull(stamps, 0.5);
  EXPECT_GT(errors_of_line(stamps, line).slope, 200e-6);
}

TEST(ErrorsOfLine, AreNumbersWhereStampsAreYearsApart) {
  for (const double far : {1e4, 1.7e9, 1e12}) {
    std::vector<Stamp> stamps = {{-far, 700}};
    for (int i = 0; i < 46; ++i) stamps.push_back({0.25 * i, 1e-4 * ((i * 7919) % 97)});
    double sum = 0;
    for (const auto& stamp : stamps) sum += stamp.device;
    const auto line = line_by_convex_hull(stamps, sum / static_cast<double>(stamps.size()));
    const double error = errors_of_line(stamps, line).slope;
    EXPECT_TRUE(std::isfinite(error) && error > 0) << far << ": " << error;
  }
}

TEST(ErrorsOfLine, AreNotBelowTheResolutionOfTheStamps) {
  std::vector<Stamp> stamps;
  for (int i = 0; i < 500; ++i) stamps.push_back({0.02 * i, 1e-3});
  const auto errors = errors_of_line(stamps, line_by_convex_hull(stamps, 5), 1e-6);
  EXPECT_EQ(errors.at_center, 1e-6);
  EXPECT_GT(errors.slope, 0.1e-6 / 10);  // a microsecond over ten seconds, not much less
  EXPECT_LT(errors.slope, 10e-6 / 10);
}

}  // namespace
}  // namespace crisp
