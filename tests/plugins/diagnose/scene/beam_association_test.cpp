// SPDX-License-Identifier: BSD-3-Clause
// Beams are associated with walls, by numbers worked out by hand.
#include "plugins/diagnose/scene/beam_association.hpp"

#include <gmock/gmock.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <random>

#include "plugins/diagnose/scene/mixed_pixels.hpp"

namespace crisp {
namespace {

using namespace crisp::diagnose;
using namespace crisp::quality;

/// A laser at the origin, and beams from it.
struct Fan {
  std::vector<double> x, y, z, dx, dy, dz;
  std::vector<float> ranges;

  void add(const Eigen::Vector3d& direction, double range) {
    const Eigen::Vector3d unit = direction.normalized();
    for (auto [values, value] : {std::pair(&x, range * unit.x()),
                                 {&y, range * unit.y()},
                                 {&z, range * unit.z()},
                                 {&dx, unit.x()},
                                 {&dy, unit.y()},
                                 {&dz, unit.z()}}) {
      values->push_back(value);
    }
    ranges.push_back(static_cast<float>(range));
  }
  BeamsView view() const { return {.points = {x, y, z}, .directions = {dx, dy, dz}, .views = {}}; }
};

/// A wall 4 m ahead, 4 m wide and high, and a smaller one 2 m ahead that occludes its middle.
class TwoWalls : public testing::Test {
 protected:
  static constexpr int kBeams = 201;  // along a side
  static constexpr double kStep = 0.02;

  void SetUp() override {
    for (int row = 0; row < kBeams; ++row) {
      for (int column = 0; column < kBeams; ++column) {
        const Eigen::Vector3d at(4, kStep * row - 2, kStep * column - 2);
        const bool is_hidden = std::abs(at.y()) < 1 && std::abs(at.z()) < 1;
        fan_.add(at, is_hidden ? at.norm() / 2 : at.norm());
      }
    }
  }
  std::size_t beam_at(double y, double z) const {
    const auto along = [](double at) { return static_cast<std::size_t>(std::lround((at + 2) / kStep)); };
    return along(y) * kBeams + along(z);
  }
  BeamAssociation association() const {
    return associate_beams(find_surfels(fan_.view(), {}), fan_.view(), fan_.ranges);
  }

  Fan fan_;
};

TEST_F(TwoWalls, EachBeamIsAssociatedWithTheFirstAhead) {
  fan_.ranges[beam_at(1.5, 0)] -= 0.5F;  // an object in front
  const std::size_t changed = beam_at(1.5, 0);
  const Eigen::Vector3d direction(fan_.dx[changed], fan_.dy[changed], fan_.dz[changed]);
  const double range{fan_.ranges[changed]};
  fan_.x[changed] = range * direction.x();
  fan_.y[changed] = range * direction.y();
  fan_.z[changed] = range * direction.z();
  const BeamAssociation followed = association();
  const std::size_t behind = beam_at(-1.5, 0);
  const std::size_t before = beam_at(0, 0);
  ASSERT_NE(followed.ahead[behind], kNoSurface);
  ASSERT_NE(followed.ahead[before], kNoSurface);
  EXPECT_NE(followed.ahead[behind], followed.ahead[before]);
  EXPECT_NEAR(followed.error[behind], 0, 1e-4);
  EXPECT_NEAR(followed.cosine[before], 1, 1e-4);
  EXPECT_NEAR(followed.cosine[behind], 4 / std::hypot(4, 1.5), 1e-4);
  EXPECT_EQ(followed.ahead[changed], followed.ahead[behind]);
  EXPECT_NEAR(followed.error[changed], -0.5, 1e-4);
}

TEST_F(TwoWalls, NothingIsAheadAtTheirRims) {
  const BeamAssociation followed = association();
  EXPECT_EQ(followed.ahead[beam_at(2, 0)], kNoSurface) << "not all cells around are known";
  EXPECT_NE(followed.end[beam_at(1.9, 0)], kNoSurface) << "but ends there";
}

TEST(BeamAssociation, DoesNotUseABeamToConfirmItsOwnSurface) {
  // Six random beams per cell, half of them outliers that do not define the wall.
  constexpr int kEach = 38'400;
  constexpr double kSide = 8;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<> across(-kSide / 2, kSide / 2);
  Fan fan;
  Surfels wall;
  for (std::uint32_t i = 0; i < 2 * kEach; ++i) {
    const Eigen::Vector3d at(6, across(random), across(random));
    fan.add(at, at.norm() + (i % 2 == 0 ? 0 : 0.1));
    wall.members.push_back(i);
    wall.weights.push_back(i % 2 == 0 ? 1 : 0);
  }
  wall.surfels.push_back({.middle = {6, 0, 0},
                          .normal = -Eigen::Vector3d::UnitX(),
                          .u = Eigen::Vector3d::UnitY(),
                          .v = Eigen::Vector3d::UnitZ(),
                          .radius = kSide / std::sqrt(6),
                          .begin = 0,
                          .end = 2 * kEach});
  const BeamAssociation association = associate_beams(wall, fan.view(), fan.ranges);
  std::array<double, 2> share{};
  for (std::size_t i = 0; i < association.size(); ++i) {
    if (association.ahead[i] != kNoSurface) share.at(i % 2) += 1.0 / kEach;
  }
  EXPECT_GT(share[0], 0.4);
  EXPECT_LT(share[0], 0.8) << "otherwise all cells are known, and the test is void";
  // Beams of one cell are correlated: about six count as one.
  const double chance = std::sqrt(2 * share[0] * (1 - share[0]) / (kEach / 6.0));
  EXPECT_NEAR(share[0], share[1], 3 * chance);
}

TEST(PointDensity, CountsThePointsNearAPosition) {
  const std::vector<double> x = {0, 0.01, 0.05, 1}, y = {0, 0, 0, 0}, z = {0, 0, 0, 0};
  const PointDensity density({x, y, z});
  EXPECT_EQ(density.about(0, 0, 0), 3);
  EXPECT_EQ(density.about(1, 0, 0), 1);
  EXPECT_EQ(density.about(2, 0, 0), 0);
  EXPECT_EQ(density.about(-0.01, 0, 0), 2) << "negative coordinates have their own cells";
}

}  // namespace
}  // namespace crisp
