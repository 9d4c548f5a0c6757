// SPDX-License-Identifier: BSD-3-Clause
// Beams are followed to the walls before them, by numbers that can be worked out by hand.
#include "plugins/diagnose/met.hpp"

#include <gmock/gmock.h>

#include <Eigen/Core>
#include <cmath>

#include "plugins/diagnose/edges.hpp"

namespace crisp {
namespace {

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

/// A wall 4 m ahead, 4 m wide and high, and a smaller one 2 m ahead that hides its middle.
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
  Met met() const { return met_by(find_surfels(fan_.view(), {}), fan_.view(), fan_.ranges); }

  Fan fan_;
};

TEST_F(TwoWalls, EachBeamHasTheFirstAheadOfIt) {
  fan_.ranges[beam_at(1.5, 0)] -= 0.5F;  // something in front
  const std::size_t changed = beam_at(1.5, 0);
  const Eigen::Vector3d direction(fan_.dx[changed], fan_.dy[changed], fan_.dz[changed]);
  const double range{fan_.ranges[changed]};
  fan_.x[changed] = range * direction.x();
  fan_.y[changed] = range * direction.y();
  fan_.z[changed] = range * direction.z();
  const Met followed = met();
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
  const Met followed = met();
  EXPECT_EQ(followed.ahead[beam_at(2, 0)], kNoSurface) << "not known all around";
  EXPECT_NE(followed.end[beam_at(1.9, 0)], kNoSurface) << "but ends there";
}

TEST(ACrowd, CountsThePointsAboutAPlace) {
  const std::vector<double> x = {0, 0.01, 0.05, 1}, y = {0, 0, 0, 0}, z = {0, 0, 0, 0};
  const Crowd crowd({x, y, z});
  EXPECT_EQ(crowd.about(0, 0, 0), 3);
  EXPECT_EQ(crowd.about(1, 0, 0), 1);
  EXPECT_EQ(crowd.about(2, 0, 0), 0);
  EXPECT_EQ(crowd.about(-0.01, 0, 0), 2) << "the cells below nought are cells of their own";
}

}  // namespace
}  // namespace crisp
