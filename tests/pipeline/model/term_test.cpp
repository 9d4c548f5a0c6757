// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <cmath>

#include <crisp/error.hpp>
#include <crisp/term.hpp>

#include "tests/pipeline/model/support.hpp"

namespace crisp {
namespace {

using testing::HasSubstr;

/// Nine coefficients of a polynomial in θ that is added to the range: more than one Jet holds.
struct Polynomial final : DifferentiableTerm<Polynomial> {
  const TermInfo& info() const override {
    static const TermInfo kInfo = [] {
      TermInfo info{.name = "test.polynomial", .phase = Phase::kRange, .scope = Scope::kPlate};
      for (int i = 0; i < 9; ++i) info.parameters.push_back({.name = "c" + std::to_string(i), .unit = "m"});
      return info;
    }();
    return kInfo;
  }
  template <class T>
  void change(Beam<T>& beam, std::span<const T> c) const {
    T power(1);
    for (const T& coefficient : c) {
      beam.range += coefficient * power;
      power *= beam.mirror_angle;
    }
  }
};

/// The beam sweeps a cone.
struct Cone final : DifferentiableTerm<Cone> {
  const TermInfo& info() const override {
    static const TermInfo kInfo{.name = "test.cone",
                                .phase = Phase::kBeam,
                                .scope = Scope::kLaser,
                                .parameters = {{.name = "kappa", .unit = "rad"}}};
    return kInfo;
  }
  template <class T>
  void change(Beam<T>& beam, std::span<const T> p) const {
    using std::cos;
    using std::sin;
    beam.direction *= cos(p[0]);
    beam.direction.z() += sin(p[0]);
  }
};

/// A term with declarations and no effect.
struct Declared final : DifferentiableTerm<Declared> {
  explicit Declared(TermInfo info) : info_(std::move(info)) {}
  const TermInfo& info() const override { return info_; }
  template <class T>
  void change(Beam<T>&, std::span<const T>) const {}

 private:
  TermInfo info_;
};

TermRegistry registry() {
  TermRegistry terms;
  terms.add(std::make_shared<Polynomial>());
  terms.add(std::make_shared<Cone>());
  return terms;
}

Calibration with_terms() {
  Calibration calibration = one_laser(0.3, 0.2, 0.1);
  calibration.lasers[0].terms.push_back({"test.cone", {{"kappa", "rad", 0.02}}});
  TermParameters polynomial{"test.polynomial", {}};
  for (int i = 0; i < 9; ++i)
    polynomial.parameters.push_back({"c" + std::to_string(i), "m", 0.001 * (i + 1)});
  calibration.plate_terms.push_back(polynomial);
  return calibration;
}

TEST(ModelTerm, AConeLiftsTheBeamOutOfItsScanPlane) {
  // θ = 0 points down (−z); the laser's z is the plate's x: sin κ · r outwards.
  Calibration calibration = one_laser(0, 0.2, 0);
  calibration.lasers[0].terms.push_back({"test.cone", {{"kappa", "rad", 0.01}}});
  const auto placed = SensorModel(calibration, registry()).place(one_beam(2, 0), turning_plate(0));
  EXPECT_NEAR(
      (placed.points.col(0) - Eigen::Vector3d(0.2 + 2 * std::sin(0.01), 0, -2 * std::cos(0.01))).norm(), 0,
      1e-6);
}

TEST(ModelTerm, ItsParametersAreNamedAfterTheirOwner) {
  const SensorModel model(with_terms(), registry());
  EXPECT_EQ(model.names()[4], "laser1.test.cone.kappa");
  EXPECT_EQ(model.names()[5], "plate.test.polynomial.c0");
  EXPECT_EQ(model.names().size(), 4U + 1 + 9);
  EXPECT_EQ(model.index("plate.test.polynomial.c8"), 13U);
}

TEST(ModelTerm, IsDifferentiatedInAsManyPassesAsItsParametersNeed) {
  const SensorModel model(with_terms(), registry());
  std::vector<std::size_t> free(model.names().size());
  for (std::size_t i = 0; i < free.size(); ++i) free[i] = i;
  PointDerivatives derivatives;
  const auto placed = model.place(one_beam(3, 1.1), turning_plate(0.4, 3), free, derivatives);
  ASSERT_EQ(derivatives.stride, free.size());
  for (std::size_t f = 0; f < free.size(); ++f) {
    constexpr double kStep = 1e-6;
    SensorModel moved = model;
    Eigen::VectorXd values = model.values();
    values[static_cast<Eigen::Index>(f)] += kStep;
    moved.set_values(values);
    const Eigen::Vector3d up = moved.place(one_beam(3, 1.1), turning_plate(0.4, 3)).points.col(0);
    const Eigen::Vector3d difference = (up - placed.points.col(0)) / kStep;
    EXPECT_NEAR((difference - derivatives.values.col(static_cast<Eigen::Index>(f))).norm(), 0, 1e-4)
        << model.names()[f];
  }
}

TEST(ModelTerm, ThatIsUnknownMisplacedOrHasOtherParametersIsRefused) {
  Calibration calibration = one_laser(0, 0.2, 0);
  calibration.lasers[0].terms.push_back({"test.cone", {{"kappa", "rad", 0.01}}});
  EXPECT_THROW(SensorModel(calibration, TermRegistry{}), Error);
  calibration.lasers[0].terms[0].parameters[0].name = "kapa";
  EXPECT_THROW(SensorModel(calibration, registry()), Error);
  calibration = one_laser(0, 0.2, 0);
  calibration.plate_terms.push_back({"test.cone", {{"kappa", "rad", 0.01}}});
  EXPECT_THROW(SensorModel(calibration, registry()), Error);
}

TEST(TermRegistry, RefusesATermThatDeclaresItselfWrongly) {
  const auto complaint = [](TermInfo info) -> std::string {
    try {
      TermRegistry().add(std::make_shared<Declared>(std::move(info)));
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  };
  const EffectParameter a{.name = "a", .unit = "m", .lower = -1, .upper = 1};
  EffectParameter beyond = a;
  beyond.neutral = 2;
  EXPECT_EQ(complaint({.name = "mine.ripple", .parameters = {a}}), "");
  EXPECT_THAT(complaint({.name = "Ripple"}), HasSubstr("'Ripple' is not a model term's name"));
  EXPECT_THAT(complaint({.name = "mine.ripple", .parameters = {a, a}}),
              HasSubstr("'a' wrongly: it is declared twice"));
  EXPECT_THAT(complaint({.name = "mine.ripple", .parameters = {{.name = "A b", .unit = "m"}}}),
              HasSubstr("'A b'"));
  EXPECT_THAT(complaint({.name = "mine.ripple", .parameters = {{.name = "a"}}}), HasSubstr("no unit"));
  EXPECT_THAT(complaint({.name = "mine.ripple", .parameters = {beyond}}), HasSubstr("not within its bounds"));
}

TEST(TermRegistry, RefusesANameTwice) {
  TermRegistry terms = registry();
  EXPECT_THROW(terms.add(std::make_shared<Cone>()), Error);
  EXPECT_EQ(terms.names(), (std::vector<std::string>{"test.cone", "test.polynomial"}));
}

}  // namespace
}  // namespace crisp
