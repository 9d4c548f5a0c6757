// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/selection.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <random>
#include <set>

#include "tests/plugins/diagnose/least_squares.hpp"
#include "tests/support/built_in_terms.hpp"

namespace crisp {
namespace {

using testing::UnorderedElementsAre;

/// Causes of one parameter each, in this order.
std::vector<Candidate> some(const std::vector<std::string>& names) {
  const auto all = candidates(built_in_terms(), nominal_calibration(default_rig()), {0, 10});
  std::vector<Candidate> found;
  for (const std::string& name : names) found.push_back(*std::ranges::find(all, name, &Candidate::name));
  return found;
}

/// Residuals of unit noise of n beams: what is off, and what a unit of each candidate does, in directions
/// that the beams are evenly spread over.
///
/// @param off   p
/// @param does  p × candidates
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
                                const std::set<std::string>& refused = {}) {
  const SensorModel model(nominal_calibration(default_rig()), built_in_terms());
  const Dictionary dictionary(model, {}, some(names), built_in_terms());
  std::vector<std::string> result;
  for (const Choice& choice : choose(dictionary, equations, {}, refused))
    result.push_back(dictionary.candidates()[choice.candidate].name);
  return result;
}

/// The second does nearly what the first does and the fourth a part of the rest; the third is no part of it.
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

/// As long as the third is not known, the second looks the best; beside it the fourth would make up for what
/// it is off by.
TEST(Selection, TakesOneCauseRatherThanAnotherWithAThirdThatMakesUpForTheDifference) {
  const auto equations = equations_of(Eigen::Vector3d(2, 1, 0), what_they_do(), 40'000);
  EXPECT_THAT(chosen(kNames, equations), UnorderedElementsAre("laser2.range.scale", "laser1.range.offset"));
}

TEST(Selection, KeepsAThirdCauseThatIsThere) {
  const auto equations = equations_of(Eigen::Vector3d(2, 1, 0.1), what_they_do(), 40'000);
  const auto names = chosen(kNames, equations);
  EXPECT_EQ(names.size(), 3);
  EXPECT_THAT(names, testing::IsSupersetOf({"laser1.range.offset", "laser1.mirror.cone"}));
}

TEST(Selection, TakesNothingThatIsPartOfWhatWasRefused) {
  const auto equations = equations_of(Eigen::Vector3d(0.1, 1, 0), what_they_do(), 40'000);
  EXPECT_EQ(chosen(kNames, equations).size(), 2) << "one of the scales, which so little cannot tell apart";
  for (const std::string one : {"laser1.range.scale", "laser2.range.scale"}) {
    EXPECT_THAT(chosen(kNames, equations, {one}), UnorderedElementsAre("laser1.range.offset"));
  }
}

TEST(Selection, TakesWhatDoesMoreThanWasRefused) {
  const auto equations = equations_of(Eigen::Vector3d(1, 0, 0), what_they_do(), 40'000);
  EXPECT_THAT(chosen(kNames, equations, {"laser1.range.scale"}), UnorderedElementsAre("laser2.range.scale"));
}

}  // namespace
}  // namespace crisp
