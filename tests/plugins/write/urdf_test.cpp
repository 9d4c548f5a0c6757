// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/urdf.hpp"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <numbers>
#include <regex>

#include "pipeline/data/degree.hpp"

namespace crisp {
namespace {

using namespace crisp::data;
using namespace crisp::write;

/// The transform of the first <origin> behind a laser's joint: Rz(yaw) Ry(pitch) Rx(roll), then xyz.
Eigen::Isometry3d origin_of(const std::string& urdf, const std::string& laser) {
  const std::regex origin("name=\"" + laser +
                          R"re(_joint"[^]*?<origin xyz="(\S+) (\S+) (\S+)" rpy="(\S+) (\S+) (\S+)")re");
  std::smatch match;
  if (!std::regex_search(urdf, match, origin)) {
    ADD_FAILURE() << urdf;
    return Eigen::Isometry3d::Identity();
  }
  const auto number = [&](std::size_t i) { return std::stod(match[i].str()); };
  return Eigen::Translation3d(number(1), number(2), number(3)) *
         Eigen::AngleAxisd(number(6), Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(number(5), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(number(4), Eigen::Vector3d::UnitX());
}

struct Mounted {
  double lambda, tau, alpha, mount;
};

class Urdf : public testing::TestWithParam<Mounted> {};
INSTANTIATE_TEST_SUITE_P(OfMountings, Urdf,
                         testing::Values(Mounted{0, 0.2, 0, 45 * kDegree},
                                         Mounted{120 * kDegree, 0.2, 5 * kDegree, 45 * kDegree},
                                         Mounted{0, 0, 0, 0}, Mounted{30 * kDegree, 0.1, 90 * kDegree, 0},
                                         Mounted{-50 * kDegree, 0.3, -7 * kDegree, -90 * kDegree}));

/// By docs/concepts/frames.md: in the scan plane θ = 0 points down, θ = 90° along the laser's circle (turned
/// by α), θ = reported angle less mount; the laser is at τ from the axis in the direction λ.
TEST_P(Urdf, PutsABeamWhereTheFramesPageDefines) {
  const auto& [lambda, tau, alpha, mount] = GetParam();
  Calibration calibration;
  calibration.lasers.push_back({.name = "front"});
  calibration.lasers[0].lambda.value = lambda;
  calibration.lasers[0].tau.value = tau;
  calibration.lasers[0].alpha.value = alpha;
  Rig rig;
  rig.lasers = {{.name = "front", .mount = mount}};
  const auto plate_from_laser = origin_of(to_urdf(calibration, rig), "front");
  const double range = 3;
  for (const double reported : {0.0, 0.7, 2.0, -1.0}) {
    const double theta = reported - mount;
    const double along = range * std::sin(theta);
    const double tangent = lambda + alpha + std::numbers::pi / 2;
    const Eigen::Vector3d expected(tau * std::cos(lambda) + along * std::cos(tangent),
                                   tau * std::sin(lambda) + along * std::sin(tangent),
                                   -range * std::cos(theta));
    const Eigen::Vector3d in_laser(range * std::cos(reported), range * std::sin(reported), 0);
    EXPECT_LT((plate_from_laser * in_laser - expected).norm(), 1e-7) << reported;
  }
}

}  // namespace
}  // namespace crisp
