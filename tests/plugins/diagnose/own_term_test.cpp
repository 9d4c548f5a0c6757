// SPDX-License-Identifier: BSD-3-Clause
// A term that a plugin adds takes part in the diagnosis like built-in ones.
#include <gmock/gmock.h>

#include <crisp/effect_catalogue.hpp>

#include "tests/plugins/diagnose/hidden.hpp"

namespace crisp {
namespace {

using namespace crisp::diagnose;
using namespace crisp::estimate;
using namespace crisp::simulate;

/// An effect that no built-in cause describes.
struct Ripple final : DifferentiableTerm<Ripple> {
  const TermInfo& info() const override {
    static const TermInfo kInfo{
        .name = "mine.ripple",
        .summary = "ranges ripple with the mirror's angle",
        .phase = Phase::kRange,
        .scope = Scope::kLaser,
        .parameters = {{.name = "a", .unit = "m", .lower = -0.1, .upper = 0.1, .summary = "of sin 7θ"}},
        .details = "`r + a sin 7θ`"};
    return kInfo;
  }
  template <class T>
  void change(Beam<T>& beam, std::span<const T> p) const {
    beam.range += p[0] * std::sin(7 * beam.measured_mirror);
  }
};

TEST(PluginTerm, IsNamedLikeTheBuiltInOnes) {
  TermRegistry terms;
  register_built_in(terms);
  terms.add(std::make_shared<Ripple>());
  ScannerSettings scanner = test::scanner_of(61, 4);
  add_requested_terms(scanner.truth, {"laser3.mine.ripple"}, terms);
  test::term_of(scanner.truth, "laser3.mine.ripple").parameters.at(0).value = 0.011;
  const auto made = simulate_measurements(scanner, office(), terms);
  const Diagnosis diagnosis = diagnose::diagnose(SensorModel(nominal_calibration(default_rig()), terms),
                                                 {.beams = made.beams, .plate = &made.plate}, terms, {});
  EXPECT_THAT(test::names_in(diagnosis), testing::ElementsAre("laser3.mine.ripple"));
  const auto reported = test::estimates_of(diagnosis, scanner.truth, "laser3.mine.ripple");
  ASSERT_EQ(reported.size(), 1U);
  EXPECT_LT(std::abs(reported[0].error()), 3.5);
}

}  // namespace
}  // namespace crisp
