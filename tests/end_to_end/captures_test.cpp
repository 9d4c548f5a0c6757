// SPDX-License-Identifier: BSD-3-Clause
// Twenty recordings of 10 s, each calibrated from nominal values that are off by up to 2 cm, 3°, 5° and 40
// ms.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <crisp/calibration_file.hpp>

#include "grabbers/simulate/scenes.hpp"
#include "pipeline/data/degree.hpp"
#include "tests/end_to_end/calibration_errors.hpp"
#include "tests/end_to_end/pipeline_fixture.hpp"
#include "tests/end_to_end/scene_distance.hpp"

namespace crisp {
namespace {

using namespace crisp::app;
using namespace crisp::data;
using namespace crisp::simulate;

/// The result of a calibrating stage in the summary.
Calibration found_by(const nlohmann::json& stage, const Calibration& truth) {
  Calibration calibration = truth;
  for (auto& laser : calibration.lasers) {
    const auto& of = stage.at("report").at("lasers").at(laser.name);
    for (auto* p : {&laser.lambda, &laser.tau, &laser.alpha, &laser.eta})
      p->value = of.at(p->name).at("value");
  }
  return calibration;
}

std::string in_words(const test::CalibrationErrors& errors) {
  return fmt::format("{:.4f} deg {:.3f} mm {:.4f} deg {:.4f} ms", errors.lambda / kDegree, errors.tau * 1e3,
                     errors.alpha / kDegree, errors.eta * 1e3);
}

class Captures : public testing::TestWithParam<int> {};

TEST_P(Captures, AreCalibratedAndTheCloudIsAsNearToTheSurfacesAsTheTruthPutsIt) {
  const int seed = GetParam();
  const auto& scenes = built_in_scenes();
  const std::string& scene = scenes[static_cast<std::size_t>(seed) % scenes.size()];
  const test::PipelineFixture fixture;
  fixture.simulate("made", {"scene=" + scene, fmt::format("seed={}", seed)});
  const auto outcome = fixture.run("calibrate.yaml", fixture / "made/hub.pcap", "out");
  ASSERT_EQ(outcome.status, ExitStatus::done) << outcome.console;

  const auto truth = read_calibration(fixture / "made/truth.yaml");
  const auto errors = test::errors_of(read_calibration(fixture / "out/calibration.yaml"), truth);
  EXPECT_LE(errors.tau, 0.003);
  EXPECT_LE(errors.lambda, 0.3 * kDegree);
  EXPECT_LE(errors.alpha, 0.3 * kDegree);
  EXPECT_LE(errors.eta, 0.4e-3);

  const auto true_cloud = fixture.assemble("made", "true");
  const Scene world = built_in_scene(scene);
  constexpr std::size_t kEvery = 40;
  const auto found = test::distance_to(world, *outcome.cloud, kEvery);
  const auto best = test::distance_to(world, *true_cloud.cloud, kEvery);
  EXPECT_LE(found.turned, 1.1 * best.turned);
  const auto by_rqe = test::errors_of(found_by(outcome.stage("calibrate.rqe"), truth), truth);
  std::cout << fmt::format(
      "{:6} {:2}: rqe {}, refined {}, distance {:.3f} mm, of the truth {:.3f} mm (as it is {:.3f}, {:.3f})\n",
      scene, seed, in_words(by_rqe), in_words(errors), found.turned * 1e3, best.turned * 1e3,
      found.as_it_is * 1e3, best.as_it_is * 1e3);
}

INSTANTIATE_TEST_SUITE_P(Seeds, Captures, testing::Range(1, 21));

TEST(ShortCaptures, TwoMinimaThatLeadToOneAreOne) {
  for (const int seed : {7, 14, 22}) {
    const test::PipelineFixture fixture;
    fixture.simulate("made", {"scene=hall", "duration=3s", fmt::format("seed={}", seed)});
    const auto outcome = fixture.run("calibrate.yaml", fixture / "made/hub.pcap", "out");
    EXPECT_EQ(outcome.console.find("competing minimum"), std::string::npos) << outcome.console;
  }
}

}  // namespace
}  // namespace crisp
