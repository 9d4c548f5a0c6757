// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/scene_file.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <crisp/error.hpp>

#include "grabbers/simulate/ray_caster.hpp"
#include "grabbers/simulate/scenes.hpp"
#include "tests/support/source_dir.hpp"

namespace crisp {
namespace {

using namespace crisp::files;
using namespace crisp::simulate;
using Eigen::Vector3d;
using testing::HasSubstr;

Scene parse(const std::string& text) { return parse_scene(parse_yaml(text, "s.yaml")); }

std::string complaint(const std::string& text) {
  try {
    parse(text);
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing";
}

const std::string kHead = "crisp: 1\nscanner: {position: [1, 2, 50cm], yaw: 90deg}\nsurfaces:\n";

TEST(SceneFile, DescribesTheWorldFromWhereTheScannerStands) {
  const Scene scene = parse(
      kHead +
      "  - {rectangle: {corner: [1, 5, 0], a: [2, 0, 0], b: [0, 0, 3]}, name: wall, reflectance: 0.2}\n");
  ASSERT_EQ(scene.surfaces.size(), 1U);
  EXPECT_EQ(scene.surfaces[0].name, "wall");
  EXPECT_EQ(scene.surfaces[0].reflectance, 0.2);
  // The world's +y is the scanner's +x when it is turned by 90°: the corner is 3 m ahead, 0.5 m below.
  EXPECT_LT((scene.surfaces[0].corners[0] - Vector3d(3, 0, -0.5)).norm(), 1e-12);
  EXPECT_LT((scene.surfaces[0].corners[2] - Vector3d(3, -2, 2.5)).norm(), 1e-12);
}

TEST(SceneFile, TurnsThenMovesThenRepeatsAnItem) {
  const Scene scene = parse(
      "crisp: 1\nscanner: {position: [0, 0, 0]}\n"
      "shapes:\n  post:\n    - {polygon: [[1, 0, 0], [1, 0, 2], [1.1, 0, 2]]}\n"
      "surfaces:\n  - {shape: post, yaw: 90deg, at: [10, 0, 1], repeat: {count: 3, step: [0, 0, 5]}}\n");
  ASSERT_EQ(scene.surfaces.size(), 3U);
  EXPECT_LT((scene.surfaces[0].corners[0] - Vector3d(10, 1, 1)).norm(), 1e-12);
  EXPECT_LT((scene.surfaces[2].corners[0] - Vector3d(10, 1, 11)).norm(), 1e-12);
}

TEST(SceneFile, KnowsBoxesAndWalls) {
  const Scene scene = parse(
      "crisp: 1\nscanner: {position: [0, 0, 0]}\nsurfaces:\n"
      "  - {box: {from: [0, 0, 0], to: [1, 2, 3]}}\n"
      "  - {walls: {outline: [[0, 0], [4, 0], [0, 3]], from: -1, to: 1}}\n");
  ASSERT_EQ(scene.surfaces.size(), 6U + 3U);
  double area = 0;
  for (const auto& s : scene.surfaces)
    area += (s.corners[1] - s.corners[0]).norm() * (s.corners[3] - s.corners[0]).norm();
  EXPECT_NEAR(area, 2 * (2 + 3 + 6) + 2 * (3 + 4 + 5), 1e-12);
}

TEST(SceneFile, KnowsWhatIsRoundGrowsAndWalks) {
  const Scene scene =
      parse(kHead +
            "  - {cylinder: {from: [1, 2, 0], to: [1, 2, 3], radius: 10cm}, name: post}\n"
            "  - {sphere: {middle: [1, 4, 0.5], radius: 1}, depth: 20cm, reflectance: 0.3}\n"
            "  - {box: {from: [0, 0, 0], to: [1, 2, 1]}, walk: {along: [[0, 0, 0], [0, 2, 0]]}}\n");
  EXPECT_TRUE(scene.surfaces.empty());
  ASSERT_EQ(scene.bodies.size(), 3U);
  EXPECT_EQ(scene.name_of(0), "post");
  const auto& post = std::get<Cylinder>(scene.bodies[0].shape);
  EXPECT_LT((post.from - Vector3d(0, 0, -0.5)).norm(), 1e-12);
  EXPECT_LT((post.to - Vector3d(0, 0, 2.5)).norm(), 1e-12);
  EXPECT_EQ(post.radius, 0.1);
  const auto& ball = std::get<Ellipsoid>(scene.bodies[1].shape);
  EXPECT_LT((ball.middle - Vector3d(2, 0, 0)).norm(), 1e-12);
  EXPECT_EQ(scene.bodies[1].depth, 0.2);
  EXPECT_EQ(scene.reflectance_of(1), 0.3);
  const auto& block = std::get<Block>(scene.bodies[2].shape);
  EXPECT_LT((block.half - Vector3d(0.5, 1, 0.5)).norm(), 1e-12);
  EXPECT_NEAR(block.yaw, -std::numbers::pi / 2, 1e-12);
  // The world's +y is the scanner's +x; a quarter of a second at a walking pace.
  EXPECT_LT((scene.bodies[2].walk.at(0.25) - Vector3d(0.35, 0, 0)).norm(), 1e-12);
}

TEST(SceneFile, ScattersCopiesInTheRegionAndClearOfTheScanner) {
  const std::string text =
      kHead +
      "  - {sphere: {middle: [0, 0, 0], radius: 0.1}, strew: {count: 200, from: [-4, -3, 0], to: [6, 7, 1], smallest: 0.5, largest: 3, clear: 2m, seed: 7}}\n";
  const Scene scene = parse(text);
  ASSERT_EQ(scene.bodies.size(), 200U);
  double smallest = 1;
  double largest = 0;
  double mean = 0;
  for (const Body& body : scene.bodies) {
    const auto& ball = std::get<Ellipsoid>(body.shape);
    EXPECT_GE(ball.middle.head<2>().norm(), 2);
    EXPECT_LE(ball.middle.head<2>().cwiseAbs().maxCoeff(), 5);
    EXPECT_GE(ball.middle.z(), -0.5);
    EXPECT_LE(ball.middle.z(), 0.5);
    smallest = std::min(smallest, ball.radii.x());
    largest = std::max(largest, ball.radii.x());
    mean += ball.middle.x() / 200;
  }
  EXPECT_GE(smallest, 0.05);
  EXPECT_LT(smallest, 0.06);
  EXPECT_LE(largest, 0.3);
  EXPECT_GT(largest, 0.28);
  EXPECT_NEAR(mean, 0, 5 * 3.0 / std::sqrt(200));
  EXPECT_EQ(std::get<Ellipsoid>(parse(text).bodies[99].shape).middle,
            std::get<Ellipsoid>(scene.bodies[99].shape).middle);
}

TEST(SceneFile, ReportsSurfacesThatCannotGrowOrWalk) {
  EXPECT_THAT(
      complaint(kHead + "  - {rectangle: {corner: [0, 0, 0], a: [1, 0, 0], b: [0, 1, 0]}, depth: 1cm}\n"),
      HasSubstr("flat surfaces can have neither depth"));
  EXPECT_THAT(complaint(kHead + "  - {sphere: {middle: [0, 0, 0], radius: 0}}\n"),
              HasSubstr("has no volume"));
  EXPECT_THAT(complaint(kHead + "  - {sphere: {middle: [0, 0, 0], radius: 1}, depth: 0}\n"),
              HasSubstr("'depth' is not above 0; leave it out"));
  EXPECT_THAT(complaint(kHead + "  - {sphere: {middle: [0, 0, 0], radius: 1}, walk: {along: [[0, 0, 0]]}}\n"),
              HasSubstr("the walk has no length"));
  EXPECT_THAT(
      complaint(
          kHead +
          "  - {sphere: {middle: [0, 0, 0], radius: 1}, strew: {count: 2, from: [0, 2, 0], to: [2, 3, 0], clear: 9m}}\n"),
      HasSubstr("no place for scattered copies"));
}

TEST(SceneFile, ReportsEveryMistakeAtItsPlace) {
  const std::string text = complaint(
      "crisp: 1\nscanner: {position: [0, 0]}\nsurfaces:\n"
      "  - {box: {from: [0, 0, 0], to: [1, 1, 1kg]}}\n"
      "  - {boks: {from: [0, 0, 0], to: [1, 1, 1]}}\n"
      "  - {shape: chair}\n"
      "  - {rectangle: {corner: [0, 0, 0], a: [1, 0, 0], b: [2, 0, 0]}}\n"
      "  - {polygon: [[0, 0, 0], [1, 0, 0], [1, 1, 0.1], [0, 1, 0]], reflectance: 2}\n");
  EXPECT_THAT(text, HasSubstr("s.yaml:2:"));
  EXPECT_THAT(text, HasSubstr("s.yaml:4:"));
  EXPECT_THAT(text, HasSubstr("s.yaml:5:"));
  EXPECT_THAT(text, HasSubstr("did you mean 'box'?"));
  EXPECT_THAT(text, HasSubstr("there is no shape 'chair'"));
  EXPECT_THAT(text, HasSubstr("has no area"));
  EXPECT_THAT(text, HasSubstr("do not lie in one plane"));
  EXPECT_THAT(text, HasSubstr("'reflectance' is 2; give a share from 0 to 1"));
}

TEST(SceneFile, RefusesSizesThatCannotBeMeant) {
  for (
      const char* item :
      {"{box: {from: [0, 0, 0], to: [1, 1, 1]}, yaw: 1e308}", "{sphere: {middle: [0, 0, 0], radius: 1e308}}",
       "{cylinder: {from: [0, 0, 0], to: [0, 0, 1], radius: 1e200}}",
       "{sphere: {middle: [0, 0, 0], radius: 1}, depth: 1e300}",
       "{sphere: {middle: [0, 0, 0], radius: 1}, walk: {along: [[0, 0, 0], [1, 0, 0]], speed: 1e300}}",
       "{sphere: {middle: [0, 0, 0], radius: 1}, strew: {count: 2, from: [0, 0, 0], to: [1, 1, 1], largest: 1e300}}"}) {
    EXPECT_THAT(complaint(kHead + "  - " + item + "\n"), HasSubstr("is implausible")) << item;
  }
}

TEST(SceneFile, BoundsHowMuchARepetitionCanMake) {
  EXPECT_THAT(
      complaint(
          "crisp: 1\nscanner: {position: [0, 0, 0]}\n"
          "shapes:\n  a:\n    - {box: {from: [0, 0, 0], to: [1, 1, 1]}, repeat: {count: 10000, step: [2, 0, 0]}}\n"
          "surfaces:\n  - {shape: a, repeat: {count: 10000, step: [0, 2, 0]}}\n"),
      HasSubstr("more than 200000 surfaces"));
}

TEST(SceneFile, ReadsTheScenesThatUsersCopyAsTheBuiltInOnes) {
  for (const auto& name : built_in_scenes()) {
    const Scene from_file = read_scene(source_dir() + "/configs/scenes/" + name + ".yaml");
    const Scene built_in = built_in_scene(name);
    EXPECT_EQ(from_file.name, name);
    ASSERT_EQ(from_file.surfaces.size(), built_in.surfaces.size());
    ASSERT_EQ(from_file.bodies.size(), built_in.bodies.size());
    EXPECT_EQ(from_file.surfaces.back().corners, built_in.surfaces.back().corners);
  }
  EXPECT_THROW(built_in_scene("offise"), Error);
}

}  // namespace
}  // namespace crisp
