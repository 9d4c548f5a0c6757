// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/report/crispness_stage.hpp"

#include <gtest/gtest.h>

#include <crisp/cloud.hpp>
#include <crisp/neighbour_search.hpp>
#include <crisp/runner.hpp>

#include "plugins/diagnose/register.hpp"

namespace crisp {
namespace {

using namespace crisp::diagnose;

/// Outputs two points as two clouds.
class TwoPoints final : public Stage {
 public:
  static void describe(StageDescription<TwoPoints>& d) {
    d.name("test.two_points").summary("gives two points, 1 m apart").gives<Cloud>();
    d.option("points", &TwoPoints::points_, "how many").range(0, 2);
  }
  void process(const Inputs&, Outputs& out, Context&) override {
    for (int i = 0; i < points_; ++i) {
      Cloud cloud;
      Point point;
      point.x = static_cast<float>(i);
      cloud.push_back(point);
      out.give(std::move(cloud));
    }
  }

 private:
  int points_ = 2;
};

class CrispnessStageTest : public testing::Test {
 protected:
  CrispnessStageTest() {
    register_built_in(searches_);
    registrar_.attach(searches_);
    registrar_.stage<TwoPoints>();
    register_diagnose(registrar_);
    run_.registrar = &registrar_;
  }

  StageReport report_of(const StageSpec& spec, int points) {
    const StageSpec source{.stage = "test.two_points",
                           .with = {{"points", OptionScalar(std::int64_t{points})}}};
    Pipeline pipeline = build_pipeline({source, spec}, run_);
    return run_pipeline(pipeline, run_).at(1).report;
  }

  SearchRegistry searches_;
  Registrar registrar_;
  RunSettings run_;
};

TEST_F(CrispnessStageTest, ReportsTheEntropyOfAllPointsTogether) {
  const OptionValue sigmas = std::vector<OptionScalar>{0.5, 0.01};
  const auto report = report_of({.stage = "diagnose.crispness", .with = {{"sigma", sigmas}}}, 2);
  // E = G(0) (1 + e^(-d²/4σ²)) / 2: for σ = 0.5 m both points interact, for 0.01 m they do not.
  const auto& widths = report.section.at("widths");
  EXPECT_EQ(report.section.at("points"), 2);
  EXPECT_NEAR(widths.at(0).at("rqe"), -std::log(std::pow(3.14159265, -1.5) * 0.5 * (1 + std::exp(-1.0))),
              1e-5);
  EXPECT_NEAR(widths.at(1).at("rqe"), -std::log(0.5 * std::pow(4e-4 * 3.14159265, -1.5)), 1e-5);
  EXPECT_EQ(widths.at(0).at("neighbours"), 1);
  EXPECT_EQ(report.lines.size(), 2U);
}

TEST_F(CrispnessStageTest, WarnsWithoutPoints) {
  EXPECT_EQ(report_of({.stage = "diagnose.crispness"}, 0).warnings.size(), 1U);
}

TEST_F(CrispnessStageTest, RejectsAnUnknownSearch) {
  const OptionValue octopus = OptionScalar(std::string("octopus"));
  EXPECT_THROW(report_of({.stage = "diagnose.crispness", .with = {{"search", octopus}}}, 2), Error);
}

}  // namespace
}  // namespace crisp
