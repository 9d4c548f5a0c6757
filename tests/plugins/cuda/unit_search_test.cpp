// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/cuda/unit_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include <crisp/rqe.hpp>

#include "pipeline/quality/searches.hpp"
#include "tests/pipeline/quality/awkward_clouds.hpp"
#include "tests/plugins/cuda/runners.hpp"

namespace crisp::cuda {
namespace {

using namespace crisp::quality;

/// Stands in for the threads of a block: they take each step one after the other.
template <class Real>
struct HostLanes {
  std::array<Lane<Real>, kLanes> lanes{};

  template <class Step>
  constexpr void each(const Step& step) {
    for (std::uint32_t k = 0; k < kLanes; ++k) step(k, lanes[k]);
  }
};

template <class Real>
void sum_all(const CellPlan& plan, const PlanView& view, const PairKernel& kernel, const Results& results) {
  Shared<Real> shared{};
  for (std::uint32_t unit = 0; unit < plan.units.size(); ++unit) {
    HostLanes<Real> lanes;
    sum_unit<Real>(view, kernel, unit, lanes, shared, results);
  }
}

UnitSums sum_on_host(const CellPlan& plan, const PointsView& points, std::span<const double> weights,
                     const PairKernel& kernel, bool gradient) {
  UnitSums sums;
  sums.kernel.resize(plan.units.size());
  sums.pairs.resize(plan.units.size());
  if (gradient) sums.gradient.assign(points.size(), 0);
  const PlanView view{points.x.data(),         points.y.data(),   points.z.data(),  weights.data(),
                      plan.order.index.data(), plan.units.data(), plan.near.data(), plan.near_begin.data()};
  const Results results{gradient ? sums.gradient.x.data() : nullptr, sums.gradient.y.data(),
                        sums.gradient.z.data(), sums.kernel.data(), sums.pairs.data()};
  (plan.needs_double ? sum_all<double> : sum_all<float>)(plan, view, kernel, results);
  return sums;
}

SumUnits take_plan_to_host(const CellPlan& plan) {
  return [&plan](const auto&... cloud) { return sum_on_host(plan, cloud...); };
}

std::vector<Runner> all_runners() {
  std::vector<Runner> runners = gpu_runners();
  runners.push_back({"Host", take_plan_to_host, ""});
  return runners;
}

/// The same tests for what a graphics processor runs, here by the processor and, where there is one, there.
class UnitSearchOn : public testing::TestWithParam<Runner> {
 protected:
  void SetUp() override {
    if (!GetParam().why_not.empty()) GTEST_SKIP() << "no graphics processor: " << GetParam().why_not;
  }
  static UnitSearch search() { return UnitSearch(GetParam().take_plan); }
};

double largest(const Vectors& gradient) {
  double result = 0;
  for (const auto* axis : {&gradient.x, &gradient.y, &gradient.z}) {
    for (const double g : *axis) result = std::max(result, std::abs(g));
  }
  return result;
}

TEST_P(UnitSearchOn, GivesTheEntropyOfTheExactSearch) {
  for (const auto& [what, cloud] : test::awkward_clouds()) {
    const auto weights = test::random_weights(cloud.size(), 13);
    ExactSearch exact;
    auto units = search();
    const auto truth = rqe(cloud.view(), weights, {.sigma = 0.02}, exact);
    const auto result = rqe(cloud.view(), weights, {.sigma = 0.02}, units);
    const double at_the_radius = test::pairs_between(cloud, 7 * 0.02 * (1 - 1e-6), 7 * 0.02 * (1 + 1e-6));
    const double scale = std::max(1 / 0.02, largest(truth.gradient));
    EXPECT_NEAR(result.value, truth.value, 2e-6) << what;
    EXPECT_NEAR(static_cast<double>(result.pairs), static_cast<double>(truth.pairs), at_the_radius) << what;
    EXPECT_NEAR(result.error_bound, truth.error_bound, 1e-5 * truth.error_bound) << what;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      EXPECT_NEAR(result.gradient.x[i], truth.gradient.x[i], 2e-6 * scale) << what;
      EXPECT_NEAR(result.gradient.y[i], truth.gradient.y[i], 2e-6 * scale) << what;
      EXPECT_NEAR(result.gradient.z[i], truth.gradient.z[i], 2e-6 * scale) << what;
    }
  }
}

TEST_P(UnitSearchOn, HoldsForUnitsThatAreFullAndTilesThatAreCutShort) {
  for (const std::size_t n : {63U, 64U, 65U, 127U, 129U, 700U}) {
    const auto cloud = test::random_cube(n, 0.1, static_cast<unsigned>(n));
    ExactSearch exact;
    auto units = search();
    const auto truth = rqe(cloud.view(), {}, {.sigma = 0.02, .cutoff = 4}, exact);
    const auto result = rqe(cloud.view(), {}, {.sigma = 0.02, .cutoff = 4}, units);
    EXPECT_NEAR(result.value, truth.value, 2e-6) << n;
    EXPECT_NEAR(result.gradient.x[n - 1], truth.gradient.x[n - 1], 2e-6 * largest(truth.gradient)) << n;
  }
}

TEST_P(UnitSearchOn, IsTheSameToTheLastBitEachTime) {
  const auto cloud = test::room_corner(5000, 2, 0.01, 3);
  auto units = search();
  const auto one = rqe(cloud.view(), {}, {.sigma = 0.02}, units);
  const auto other = rqe(cloud.view(), {}, {.sigma = 0.02}, units);
  EXPECT_EQ(one.value, other.value);
  EXPECT_EQ(one.gradient.x, other.gradient.x);
}

/// Each point moved by up to so much along each axis [m].
Vectors moved(Vectors cloud, double most, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> by(-most, most);
  for (auto* axis : {&cloud.x, &cloud.y, &cloud.z}) {
    for (double& at : *axis) at += by(random);
  }
  return cloud;
}

TEST_P(UnitSearchOn, HoldsForPointsThatHaveMovedLittleOrFarSinceTheyWerePlanned) {
  const auto planned = test::random_cube(3000, 0.5, 5);
  ExactSearch exact;
  for (const double most : {0.001, 0.0048, 0.05}) {  // [m]; a plan serves to 5 mm, a twentieth of the radius
    auto units = search();
    const auto before = rqe(planned.view(), {}, {.sigma = 0.02, .cutoff = 5}, units);
    const auto cloud = moved(planned, most, 6);
    const auto weights = test::random_weights(cloud.size(), 7);
    const auto truth = rqe(cloud.view(), weights, {.sigma = 0.02, .cutoff = 5}, exact);
    const auto result = rqe(cloud.view(), weights, {.sigma = 0.02, .cutoff = 5}, units);
    EXPECT_EQ(result.tested == before.tested, most < 0.005) << most;
    EXPECT_NEAR(result.value, truth.value, 2e-6) << most;
    EXPECT_EQ(result.pairs, truth.pairs) << most;
    EXPECT_NEAR(result.error_bound, truth.error_bound, 1e-5 * truth.error_bound) << most;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      EXPECT_NEAR(result.gradient.x[i], truth.gradient.x[i], 2e-6 * largest(truth.gradient)) << most;
    }
  }
}

TEST_P(UnitSearchOn, PlansAnewForAnotherKernelAndAsManyOtherPoints) {
  const auto cloud = test::random_cube(2000, 0.5, 5);
  ExactSearch exact;
  auto units = search();
  rqe(cloud.view(), {}, {.sigma = 0.01}, units);
  for (const double sigma : {0.03, 0.005}) {
    EXPECT_NEAR(rqe(cloud.view(), {}, {.sigma = sigma}, units).value,
                rqe(cloud.view(), {}, {.sigma = sigma}, exact).value, 2e-6);
  }
  const auto other = test::random_cube(2000, 0.3, 8);
  EXPECT_NEAR(rqe(other.view(), {}, {.sigma = 0.005}, units).value,
              rqe(other.view(), {}, {.sigma = 0.005}, exact).value, 2e-6);
}

TEST_P(UnitSearchOn, LeavesTheGradientOutWhenItIsNotRequested) {
  const auto cloud = test::room_corner(1000, 2, 0.02, 4);
  auto units = search();
  const auto with = rqe(cloud.view(), {}, {.sigma = 0.05}, units);
  const auto without = rqe(cloud.view(), {}, {.sigma = 0.05, .gradient = false}, units);
  EXPECT_EQ(without.gradient.size(), 0U);
  EXPECT_EQ(without.value, with.value);
}

INSTANTIATE_TEST_SUITE_P(Each, UnitSearchOn, testing::ValuesIn(all_runners()),
                         [](const auto& runner) { return runner.param.name; });

}  // namespace
}  // namespace crisp::cuda
