// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/stepwise_selection.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <random>
#include <set>

#include "tests/plugins/diagnose/model/least_squares.hpp"
#include "tests/support/built_in_terms.hpp"

namespace crisp {
namespace {

using namespace crisp::diagnose;
using namespace crisp::quality;
using testing::UnorderedElementsAre;

/// Causes of one parameter each, in the order of the names.
std::vector<Candidate> some(const std::vector<std::string>& names) {
  const auto all = candidates(built_in_terms(), nominal_calibration(default_rig()), {0, 10});
  std::vector<Candidate> found;
  for (const std::string& name : names) found.push_back(*std::ranges::find(all, name, &Candidate::name));
  return found;
}

/// Normal equations of n beams of unit noise. Residuals and effects of the candidates have p components, over
/// which the beams are evenly distributed.
///
/// @param off   p: residual
/// @param does  p × candidates: effect of a unit of each
NormalEquations equations_of(const Eigen::VectorXd& off, const Eigen::MatrixXd& does, Eigen::Index n) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  test::LeastSquares problem(does.cols(), n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::VectorXd direction =
        Eigen::VectorXd::NullaryExpr(off.size(), [&] { return normal(random); });
    const double noise = -normal(random);
    problem.add(does.transpose() * direction, noise - direction.dot(off), noise);
  }
  return problem.equations();
}

std::vector<std::string> chosen(const std::vector<std::string>& names, const NormalEquations& equations,
                                const std::set<std::string>& rejected = {}) {
  const SensorModel model(nominal_calibration(default_rig()), built_in_terms());
  const CandidateJacobian jacobian(model, {}, some(names), built_in_terms());
  std::vector<std::string> result;
  for (const SelectedCandidate& choice : choose(jacobian, equations, {}, rejected))
    result.push_back(jacobian.candidates()[choice.candidate].name);
  return result;
}

/// The second nearly equals the first; the fourth explains part of the difference; the third is independent.
const std::vector<std::string> kNames = {"laser2.range.scale", "laser1.range.scale", "laser1.range.offset",
                                         "laser1.mirror.cone"};

Eigen::MatrixXd what_they_do() {
  Eigen::MatrixXd does(3, 4);
  does.col(0) << 1, 0, 0;
  does.col(1) << 1, 0.025, 0.025;
  does.col(2) << 0, 1, 0;
  does.col(3) << 0, 0, 1;
  return does;
}

/// Without the third, the second has the best score. Given the second, the fourth would compensate for its
/// error.
TEST(StepwiseSelection, ReplacesTwoCausesByAnEquivalentOne) {
  const auto equations = equations_of(Eigen::Vector3d(2, 1, 0), what_they_do(), 40'000);
  EXPECT_THAT(chosen(kNames, equations), UnorderedElementsAre("laser2.range.scale", "laser1.range.offset"));
}

TEST(StepwiseSelection, KeepsAThirdActualCause) {
  const auto equations = equations_of(Eigen::Vector3d(2, 1, 0.1), what_they_do(), 40'000);
  const auto names = chosen(kNames, equations);
  EXPECT_EQ(names.size(), 3);
  EXPECT_THAT(names, testing::IsSupersetOf({"laser1.range.offset", "laser1.mirror.cone"}));
}

TEST(StepwiseSelection, SkipsWhatARejectedCauseExplains) {
  const auto equations = equations_of(Eigen::Vector3d(0.1, 1, 0), what_they_do(), 40'000);
  EXPECT_EQ(chosen(kNames, equations).size(), 2)
      << "one of the scales, which are not resolvable at this size";
  for (const std::string one : {"laser1.range.scale", "laser2.range.scale"}) {
    EXPECT_THAT(chosen(kNames, equations, {one}), UnorderedElementsAre("laser1.range.offset"));
  }
}

TEST(StepwiseSelection, SelectsWhatARejectedCauseDoesNotExplain) {
  const auto equations = equations_of(Eigen::Vector3d(1, 0, 0), what_they_do(), 40'000);
  EXPECT_THAT(chosen(kNames, equations, {"laser1.range.scale"}), UnorderedElementsAre("laser2.range.scale"));
}

/// The lasers' scales cancel one another, and differ by little in what shows.
TEST(StepwiseSelection, SkipsACauseOfAllLasersThatIsNotDetermined) {
  const std::vector<std::string> names = {"laser1.range.scale", "laser2.range.scale", "laser3.range.scale",
                                          "laser1.mirror.cone"};
  Eigen::MatrixXd does(3, 4);
  does.col(0) << 1, 0.1, 0;
  does.col(1) << 1, -0.1, 0;
  does.col(2) << -2, 0, 0;
  does.col(3) << 0, 0, 1;
  const auto equations = equations_of(Eigen::Vector3d(0, 0.1, 1), does, 40'000);
  EXPECT_THAT(chosen(names, equations), UnorderedElementsAre("laser1.mirror.cone"));
}

}  // namespace
}  // namespace crisp
