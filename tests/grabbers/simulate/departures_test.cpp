// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/departures.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "pipeline/data/degree.hpp"
#include "pipeline/data/error.hpp"
#include "pipeline/data/rig.hpp"

namespace crisp {
namespace {

TEST(DrawTruth, StaysWithinTheDeparturesAndKeepsTheGauge) {
  const Calibration nominal = nominal_calibration(default_rig());
  const Departures departures{.tau = 0.02, .alpha = 3 * kDegree, .lambda = 5 * kDegree, .eta = 0.04};
  double widest = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const Calibration truth = draw_truth(nominal, departures, seed);
    EXPECT_EQ(truth.lasers[0].lambda.value, 0);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_LE(std::abs(truth.lasers[i].tau.value - 0.20), 0.02);
      EXPECT_LE(std::abs(truth.lasers[i].alpha.value), 3 * kDegree);
      EXPECT_LE(std::abs(truth.lasers[i].eta.value), 0.04);
      EXPECT_LE(std::abs(truth.lasers[i].lambda.value - static_cast<double>(i) * 120 * kDegree), 5 * kDegree);
      widest = std::max(widest, std::abs(truth.lasers[i].eta.value));
    }
  }
  EXPECT_GT(widest, 0.039);
  EXPECT_THROW(draw_truth(nominal, {.tau = -1}, 1), Error);
}

template <Scope kScope>
struct Toy : DifferentiableTerm<Toy<kScope>> {
  const TermInfo& info() const override {
    static const TermInfo laser{.name = "mirror.cone",
                                .summary = "",
                                .phase = Phase::kBeam,
                                .scope = Scope::kLaser,
                                .parameters = {{.name = "kappa", .unit = "rad"}}};
    static const TermInfo plate{.name = "plate.wobble",
                                .summary = "",
                                .phase = Phase::kBase,
                                .scope = Scope::kPlate,
                                .parameters = {{.name = "a", .unit = "rad"}, {.name = "b", .unit = "rad"}}};
    return kScope == Scope::kLaser ? laser : plate;
  }
  template <class T>
  void change(Beam<T>&, std::span<const T>) const {}
};

class AddEffect : public testing::Test {
 protected:
  AddEffect() {
    terms_.add(std::make_shared<Toy<Scope::kLaser>>());
    terms_.add(std::make_shared<Toy<Scope::kPlate>>());
  }
  std::string complaint(const std::string& effect) {
    try {
      add_effect(truth_, effect, terms_);
    } catch (const Error& error) {
      return error.what();
    }
    return "nothing";
  }

  TermRegistry terms_;
  Calibration truth_ = nominal_calibration(default_rig());
};

TEST_F(AddEffect, PutsATermIntoOneLaserOrIntoAll) {
  add_effect(truth_, "laser2.mirror.cone.kappa=0.3deg", terms_);
  EXPECT_TRUE(truth_.lasers[0].terms.empty());
  ASSERT_EQ(truth_.lasers[1].terms.size(), 1U);
  EXPECT_EQ(truth_.lasers[1].terms[0].term, "mirror.cone");
  EXPECT_NEAR(truth_.lasers[1].terms[0].parameters[0].value, 0.3 * kDegree, 1e-15);
  add_effect(truth_, "mirror.cone.kappa=0.01", terms_);
  for (const auto& laser : truth_.lasers) EXPECT_EQ(laser.terms[0].parameters[0].value, 0.01);
}

TEST_F(AddEffect, SetsSeveralParametersOfOneTermOfThePlate) {
  add_effect(truth_, "plate.wobble.a=0.1deg", terms_);
  add_effect(truth_, "plate.plate.wobble.b=0.2deg", terms_);
  ASSERT_EQ(truth_.plate_terms.size(), 1U);
  EXPECT_NEAR(truth_.plate_terms[0].parameters[0].value, 0.1 * kDegree, 1e-15);
  EXPECT_NEAR(truth_.plate_terms[0].parameters[1].value, 0.2 * kDegree, 1e-15);
}

TEST_F(AddEffect, SaysWhatItDoesNotUnderstand) {
  using testing::HasSubstr;
  EXPECT_THAT(complaint("mirror.cone.kappa"), HasSubstr("write it as"));
  EXPECT_THAT(complaint("kappa=3"), HasSubstr("write it as"));
  EXPECT_THAT(complaint("mirror.cone.kapa=3"), HasSubstr("it has kappa"));
  EXPECT_THAT(complaint("mirror.cone.kappa=3mm"), HasSubstr("mirror.cone.kappa=3mm"));
  EXPECT_THAT(complaint("mirror.coin.kappa=3"), HasSubstr("mirror.coin"));
  EXPECT_THAT(complaint("laser1.plate.wobble.a=3"), HasSubstr("not one laser's"));
  EXPECT_THAT(complaint("plate.mirror.cone.kappa=3"), HasSubstr("not the plate's"));
}

}  // namespace
}  // namespace crisp
