// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/calibrations_compared.hpp"

#include <gmock/gmock.h>

#include "pipeline/data/degree.hpp"

namespace crisp {
namespace {

using namespace crisp::data;
using namespace crisp::write;
using testing::ContainsRegex;
using testing::HasSubstr;

Calibration of_one_laser(double tau, double error) {
  Calibration calibration;
  LaserCalibration& laser = calibration.lasers.emplace_back();
  laser.name = "a";
  laser.tau.value = tau;
  laser.tau.std_error = error;
  return calibration;
}

TEST(CalibrationsCompared, ReportsDifferencesInUnitsOfPeopleAndInStandardErrors) {
  const std::string table = compare_calibrations(of_one_laser(0.2, 0), of_one_laser(0.2005, 0.00025));
  EXPECT_THAT(table, ContainsRegex("a.tau +mm +200.00 +200.50 +0.50 +2.0\n"));
  EXPECT_THAT(table, ContainsRegex("a.eta +ms +0.0000 +0.0000 +0.0000"));
}

TEST(CalibrationsCompared, TakesTheErrorsOfBothAndDigitsByThem) {
  const std::string table = compare_calibrations(of_one_laser(0.2, 0.003), of_one_laser(0.19, 0.004));
  EXPECT_THAT(table, ContainsRegex("a.tau +mm +200.0 +190.0 +-10.0 +-2.0\n"));
}

TEST(CalibrationsCompared, CountsNoTurnsAsADifference) {
  Calibration first = of_one_laser(0.2, 0);
  Calibration second = first;
  first.lasers[0].lambda.value = 179 * kDegree;
  second.lasers[0].lambda.value = -179 * kDegree;
  EXPECT_THAT(compare_calibrations(first, second),
              ContainsRegex("a.lambda +deg +179.0000 +-179.0000 +2.0000"));
}

TEST(CalibrationsCompared, ShowsWhatOnlyOneHas) {
  const Calibration first = of_one_laser(0.2, 0);
  Calibration second = first;
  second.plate_terms = {{"encoder.eccentricity", {{.name = "a", .unit = "rad", .value = kDegree}}}};
  second.quality["chi2"] = 1.25;
  second.caveats = {"the plate stood still"};
  const std::string table = compare_calibrations(first, second);
  EXPECT_THAT(table, ContainsRegex("plate.encoder.eccentricity.a +deg +- +1.0000 +-"));
  EXPECT_THAT(table, ContainsRegex("chi2 +- +1.25"));
  EXPECT_THAT(table, HasSubstr("\n  the second is UNTRUSTED: the plate stood still"));
}

}  // namespace
}  // namespace crisp
