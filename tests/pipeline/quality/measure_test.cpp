// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <crisp/error.hpp>
#include <crisp/measure.hpp>
#include <crisp/rqe.hpp>

#include "tests/pipeline/quality/clouds.hpp"

namespace crisp {
namespace {

/// A measure as a plugin might add it: the weighted spread of the points about their mean.
class Spread final : public Measure {
 public:
  Quality evaluate(const PointsView& points, std::span<const double>, double, bool) override {
    double mean = 0;
    for (const double x : points.x) mean += x / static_cast<double>(points.size());
    Quality quality;
    for (const double x : points.x) quality.value += (x - mean) * (x - mean);
    return quality;
  }
};

struct Measures {
  Measures() {
    register_built_in(searches);
    register_built_in(measures);
  }
  SearchRegistry searches;
  MeasureRegistry measures;
};

TEST(Measure, RqeIsTheEntropyWithTheScaleAsSigma) {
  const Measures known;
  const auto cloud = test::room_corner(400, 1, 0.01, 1);
  const auto weights = test::random_weights(400, 2);
  for (const auto& search : known.searches.names()) {
    const auto measure = known.measures.make("rqe", {.search = search, .cutoff = 8}, known.searches);
    for (const double sigma : {0.1, 0.03}) {
      const auto quality = measure->evaluate(cloud.view(), weights, sigma, true);
      const auto truth = rqe(cloud.view(), weights, {.sigma = sigma, .cutoff = 8});
      EXPECT_NEAR(quality.value, truth.value, 1e-6) << search;
      EXPECT_NEAR(quality.gradient.y[17], truth.gradient.y[17], 1e-4) << search;
      EXPECT_EQ(measure->evaluate(cloud.view(), weights, sigma, false).gradient.size(), 0U) << search;
    }
  }
}

TEST(Measure, CanBeAddedByName) {
  Measures known;
  known.measures.add("spread", "how far apart",
                     [](const auto&, const auto&) { return std::make_unique<Spread>(); });
  const Vectors two{{0, 2}, {0, 0}, {0, 0}};
  EXPECT_DOUBLE_EQ(
      known.measures.make("spread", {}, known.searches)->evaluate(two.view(), {}, 1, false).value, 2);
  EXPECT_EQ(known.measures.summary("spread"), "how far apart");
}

TEST(Measure, RefusesSearchesThatAreUnknown) {
  const Measures known;
  EXPECT_THROW(known.measures.make("rqe", {.search = "octopus"}, known.searches), Error);
}

}  // namespace
}  // namespace crisp
