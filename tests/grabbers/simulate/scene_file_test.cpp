// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/scene_file.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "grabbers/simulate/ray_caster.hpp"
#include "grabbers/simulate/scenes.hpp"
#include "pipeline/data/error.hpp"

namespace crisp {
namespace {

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
  const Scene scene = parse(kHead +
                            "  - {rectangle: {corner: [1, 5, 0], a: [2, 0, 0], b: [0, 0, 3]}, name: wall, "
                            "reflectance: 0.2}\n");
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

TEST(SceneFile, TellsEveryMistakeAtItsPlace) {
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
  EXPECT_THAT(text, HasSubstr("between 0 and 1"));
}

TEST(SceneFile, BoundsHowMuchARepetitionCanMake) {
  EXPECT_THAT(complaint("crisp: 1\nscanner: {position: [0, 0, 0]}\n"
                        "shapes:\n  a:\n    - {box: {from: [0, 0, 0], to: [1, 1, 1]}, repeat: {count: 10000, "
                        "step: [2, 0, 0]}}\n"
                        "surfaces:\n  - {shape: a, repeat: {count: 10000, step: [0, 2, 0]}}\n"),
              HasSubstr("more than 200000 surfaces"));
}

TEST(SceneFile, ReadsTheScenesThatUsersCopyAsTheBuiltInOnes) {
  for (const auto& name : built_in_scenes()) {
    const Scene from_file = read_scene(std::string(CRISP_SOURCE_DIR) + "/configs/scenes/" + name + ".yaml");
    const Scene built_in = built_in_scene(name);
    EXPECT_EQ(from_file.name, name);
    ASSERT_EQ(from_file.surfaces.size(), built_in.surfaces.size());
    EXPECT_EQ(from_file.surfaces.back().corners, built_in.surfaces.back().corners);
  }
  EXPECT_THROW(built_in_scene("offise"), Error);
}

}  // namespace
}  // namespace crisp
