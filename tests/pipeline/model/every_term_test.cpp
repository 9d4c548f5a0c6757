// SPDX-License-Identifier: BSD-3-Clause
// Properties of every term.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/pipeline/model/terms_support.hpp"

namespace crisp {
namespace {

/// Turns back and then forth, so that rates of both signs, large and small, occur; with an acceleration that
/// stays, so that the cubics between the encoder's readings continue each other.
PlateTrajectory restless_plate() {
  std::vector<double> times, angles;
  for (int i = 0; i <= 2000; ++i) {
    times.push_back(i * 0.002);
    angles.push_back(0.4 + 2.5 * (times.back() - 1.7) * (times.back() - 1.7));
  }
  return {0, times, angles, 0.01};
}

Measurements varied_beams(std::size_t n) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<float> range(0.5F, 20), angle(-1.57F, 3.14F), remission(5, 250),
      cosine(0.1F, 1);
  Measurements beams;
  for (std::size_t i = 0; i < n; ++i) {
    Measurements beam = one_beam(range(random), angle(random));
    // Not at a reading, where the direction has a kink.
    beam.time[0] = 0.3007 + 3.4 * static_cast<double>(i) / static_cast<double>(n);
    beam.laser[0] = (i / 7) % 2;
    beam.remission[0] = remission(random);
    beam.beam[0] = static_cast<std::uint16_t>(random() % 541);
    beam.cos_incidence = {cosine(random)};
    beams.append(beam);
  }
  return beams;
}

/// Values between the bounds, near the neutral one so that nothing is extreme.
std::map<std::string, double> drawn(const TermInfo& info, std::mt19937_64& random) {
  std::map<std::string, double> values;
  for (const auto& p : info.parameters) {
    const double share = std::uniform_real_distribution<double>(0.01, 0.05)(random);
    values[p.name] = p.neutral + share * (random() % 2 == 0 ? p.upper - p.neutral : p.lower - p.neutral);
  }
  if (info.name == "clock.skew") values["middle"] = 2;  // of hours, which the encoder readings do not cover
  if (info.name == "range.step") values["at"] = 2.004;  // where some beam feels its edge
  return values;
}

void add_drawn(Calibration& calibration, const TermInfo& info, std::mt19937_64& random) {
  if (info.scope == Scope::kPlate)
    return calibration.plate_terms.push_back(with_values(info, drawn(info, random)));
  for (auto& laser : calibration.lasers) laser.terms.push_back(with_values(info, drawn(info, random)));
}

Eigen::Matrix3Xd moved(const SensorModel& model, std::size_t parameter, double by) {
  SensorModel other = model;
  Eigen::VectorXd values = model.values();
  values[static_cast<Eigen::Index>(parameter)] += by;
  other.set_values(values);
  return other.place(varied_beams(120), restless_plate()).points;
}

/// Compares with differences of fourth order: (8 (f(h) − f(−h)) − (f(2h) − f(−2h))) / 12h.
void expect_right_derivatives(const SensorModel& model) {
  std::vector<std::size_t> free(model.names().size());
  for (std::size_t i = 0; i < free.size(); ++i) free[i] = i;
  PointDerivatives derivatives;
  const Measurements beams = varied_beams(120);
  const auto placed = model.place(beams, restless_plate(), free, derivatives);
  ASSERT_EQ(placed.index.size(), beams.size());
  for (std::size_t f = 0; f < free.size(); ++f) {
    const double step = 1e-5 * std::max(1e-2, std::abs(model.values()[static_cast<Eigen::Index>(f)]));
    const Eigen::Matrix3Xd difference = (8 * (moved(model, f, step) - moved(model, f, -step)) -
                                         (moved(model, f, 2 * step) - moved(model, f, -2 * step))) /
                                        (12 * step);
    for (std::size_t i = 0; i < beams.size(); ++i) {
      Eigen::Vector3d derivative = Eigen::Vector3d::Zero();
      const auto& columns = derivatives.columns[beams.laser[i]];
      for (std::size_t k = 0; k < columns.size(); ++k) {
        if (columns[k] == f)
          derivative = derivatives.values.col(static_cast<Eigen::Index>(i * derivatives.stride + k));
      }
      // Points are to 1e-14 m or so: their differences, by the step, to 1e-7 of the largest derivatives.
      EXPECT_LT((derivative - difference.col(static_cast<Eigen::Index>(i))).norm(),
                2e-6 * (1 + derivative.norm()))
          << model.names()[f] << " of beam " << i;
    }
  }
}

class EveryTerm : public testing::TestWithParam<std::string> {
 protected:
  const TermInfo& info() const { return built_in_terms().get(GetParam())->info(); }
};

INSTANTIATE_TEST_SUITE_P(BuiltIn, EveryTerm, testing::ValuesIn(built_in_terms().names()),
                         [](const auto& name) {
                           std::string text = name.param;
                           std::replace(text.begin(), text.end(), '.', '_');
                           return text;
                         });

TEST_P(EveryTerm, ChangesNothingWhileItIsNeutral) {
  Calibration calibration = two_lasers();
  if (info().scope == Scope::kPlate) {
    calibration.plate_terms.push_back(with_values(info()));
  } else {
    for (auto& laser : calibration.lasers) laser.terms.push_back(with_values(info()));
  }
  const Measurements beams = varied_beams(300);
  const auto with = SensorModel(calibration, built_in_terms()).place(beams, restless_plate());
  const auto without = SensorModel(two_lasers()).place(beams, restless_plate());
  ASSERT_EQ(with.index, without.index);
  EXPECT_LT((with.points - without.points).cwiseAbs().maxCoeff(), 1e-13);
}

TEST_P(EveryTerm, ChangesThePointsOtherwise) {
  std::mt19937_64 random(3);
  Calibration calibration = two_lasers();
  add_drawn(calibration, info(), random);
  const Measurements beams = varied_beams(300);
  const auto with = SensorModel(calibration, built_in_terms()).place(beams, restless_plate());
  const auto without = SensorModel(two_lasers()).place(beams, restless_plate());
  EXPECT_GT((with.points - without.points).cwiseAbs().maxCoeff(), 1e-4);
}

TEST_P(EveryTerm, HasDerivativesThatAgreeWithFiniteDifferences) {
  std::mt19937_64 random(5);
  Calibration calibration = two_lasers();
  add_drawn(calibration, info(), random);
  expect_right_derivatives(SensorModel(calibration, built_in_terms()));
}

TEST_P(EveryTerm, ReportsAllOfItsParameters) {
  EXPECT_FALSE(info().summary.empty());
  EXPECT_FALSE(info().details.empty());
  ASSERT_FALSE(info().parameters.empty());
  bool size = false;
  for (const auto& p : info().parameters) {
    EXPECT_LT(p.lower, p.neutral) << p.name;
    EXPECT_GT(p.upper, p.neutral) << p.name;
    EXPECT_FALSE(p.unit.empty()) << p.name;
    EXPECT_FALSE(p.summary.empty()) << p.name;
    size = size || !p.shape;
  }
  EXPECT_TRUE(size) << "shapes alone cannot have an effect";
}

TEST_P(EveryTerm, DoesNotFeelItsShapeWhileItIsNeutral) {
  Calibration calibration = two_lasers();
  add_term(calibration, GetParam());
  const SensorModel model(calibration, built_in_terms());
  for (const auto& p : info().parameters) {
    if (!p.shape) continue;
    const std::string owner = info().scope == Scope::kPlate ? "plate." : "laser1.";
    const std::size_t slot = model.index(owner + info().name + "." + p.name);
    const double by = 0.1 * (p.upper - p.neutral);
    EXPECT_LT((moved(model, slot, by) - moved(model, slot, 0)).cwiseAbs().maxCoeff(), 1e-13) << p.name;
  }
}

TEST(AllTermsTogether, HaveDerivativesThatAgreeWithFiniteDifferences) {
  std::mt19937_64 random(11);
  Calibration calibration = two_lasers();
  for (const auto& name : built_in_terms().names()) {
    add_drawn(calibration, built_in_terms().get(name)->info(), random);
  }
  calibration.lasers[1].terms.resize(5);  // the lasers' chains differ, and so do their Jets' passes
  const SensorModel model(calibration, built_in_terms());
  EXPECT_GT(model.chain(0).slots.size(), model.chain(1).slots.size() + 40U);
  expect_right_derivatives(model);
}

TEST(AllTermsTogether, ActAlikeInWhateverOrderThoseThatCorrectReadingsAreListed) {
  std::mt19937_64 random(13);
  Calibration calibration = one_laser(0.1, 0.2, -0.03, 0.004);
  for (const char* name :
       {"mount.mirror_zero", "mirror.eccentricity", "range.scale", "range.cyclic", "range.offset",
        "clock.drift", "timing.intra_scan", "encoder.eccentricity", "encoder.second_harmonic"}) {
    add_drawn(calibration, built_in_terms().get(name)->info(), random);
  }
  Measurements beams = varied_beams(100);
  beams.laser.assign(beams.size(), 0);
  const auto one = SensorModel(calibration, built_in_terms()).place(beams, restless_plate());
  std::reverse(calibration.lasers[0].terms.begin(), calibration.lasers[0].terms.end());
  std::reverse(calibration.plate_terms.begin(), calibration.plate_terms.end());
  const auto other = SensorModel(calibration, built_in_terms()).place(beams, restless_plate());
  EXPECT_LT((one.points - other.points).cwiseAbs().maxCoeff(), 1e-12);
}

}  // namespace
}  // namespace crisp
