// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/model/term_faults.hpp"

#include <gmock/gmock.h>

#include <crisp/effect_catalogue.hpp>
#include <crisp/error.hpp>
#include <crisp/sensor_model.hpp>

namespace crisp {
namespace {

using namespace crisp::model;
using testing::HasSubstr;
using testing::IsEmpty;

class TermFaults : public testing::Test {
 protected:
  TermFaults() { register_built_in(terms_); }

  static TermParameters cone(double kappa, const std::string& unit = "rad") {
    return {"mirror.cone", {{.name = "kappa", .unit = unit, .value = kappa}}};
  }
  /// "parameter: what; advice" of the first, or nothing.
  std::string fault(const TermParameters& given, TermOwner owner = TermOwner::laser) const {
    const auto faults = judge_by(terms_)(given, owner);
    if (faults.empty()) return {};
    return faults[0].parameter + ": " + faults[0].what + "; " + faults[0].advice;
  }
  TermParameters with(const std::string& term, const std::string& parameter, double value) const {
    TermParameters given = neutral_parameters(terms_.get(term)->info());
    for (auto& each : given.parameters) {
      if (each.name == parameter) each.value = value;
    }
    return given;
  }

  TermRegistry terms_;
};

TEST_F(TermFaults, ThereAreNoneInWhatATermDeclares) {
  for (const auto& name : terms_.names()) {
    const TermInfo& info = terms_.get(name)->info();
    const TermOwner owner = info.scope == Scope::kLaser ? TermOwner::laser : TermOwner::plate;
    EXPECT_EQ(fault(neutral_parameters(info), owner), "") << name;
  }
  EXPECT_EQ(fault(cone(0.1 + 1e-9)), "") << "on its bound, to an optimizer's rounding";
}

TEST_F(TermFaults, AUnitIsNeverTakenForAnother) {
  EXPECT_EQ(fault(cone(0.05, "deg")),
            "kappa: 'deg' is not the unit of mirror.cone's kappa; convert the value to rad");
  Calibration calibration;
  calibration.lasers.emplace_back().name = "a";
  calibration.lasers[0].terms = {cone(0.05, "deg")};
  EXPECT_THROW(SensorModel(calibration, terms_), Error);
}

TEST_F(TermFaults, ValuesOutOfBoundsCannotBeMeant) {
  EXPECT_THAT(fault(cone(1e6)), HasSubstr("kappa: 1e+06 rad is implausible; kappa of mirror.cone is from"));
  EXPECT_THAT(fault(with("range.cyclic", "P", 0)), HasSubstr("P: 0 m is implausible"));
  EXPECT_THAT(fault(with("range.warmup", "T", -1)), HasSubstr("T: -1 s is implausible"));
}

TEST_F(TermFaults, ATermStandsUnderWhatHasIt) {
  EXPECT_THAT(fault(cone(0), TermOwner::plate), HasSubstr("under the wrong heading"));
  EXPECT_THAT(fault({"mirror.con", {}}), HasSubstr("mirror.cone"));
  EXPECT_THAT(fault({"mirror.cone", {}}), HasSubstr("expected kappa"));
}

}  // namespace
}  // namespace crisp
