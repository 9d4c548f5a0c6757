// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/app/summary.hpp"

#include <gmock/gmock.h>

#include <crisp/calibration.hpp>

namespace crisp {
namespace {

using namespace crisp::app;
using testing::EndsWith;

RunRecord calibrated() {
  NodeResult node;
  node.given[std::string(KindName<Calibration>::value)] = 1;
  RunRecord record;
  record.options.emplace_back();
  record.nodes.push_back(std::move(node));
  return record;
}

TEST(Summary, EndsWithTheVerdict) {
  RunRecord record = calibrated();
  EXPECT_THAT(summary_text(record, false), EndsWith("The result is trusted.\n"));
  record.nodes[0].report.warnings.emplace_back("the direction is known from the rig only");
  EXPECT_THAT(summary_text(record, false), EndsWith("The result is trusted, with the warnings above.\n"));
  record.nodes[0].report.caveats.emplace_back("views disagree");
  EXPECT_THAT(summary_text(record, false), EndsWith("The result is UNTRUSTED: see the caveats above.\n"));
}

TEST(Summary, OfARunWithoutCalibrationHasNoVerdict) {
  RunRecord record = calibrated();
  record.nodes[0].given.clear();
  EXPECT_THAT(summary_text(record, false), testing::Not(testing::HasSubstr("The result")));
}

}  // namespace
}  // namespace crisp
