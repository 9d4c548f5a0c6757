// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/calibration_stage.hpp"

#include <gmock/gmock.h>

#include <crisp/calibration_file.hpp>
#include <crisp/pipeline.hpp>

#include "plugins/write/register.hpp"

namespace crisp {
namespace {

using namespace crisp::write;
namespace fs = std::filesystem;
using testing::ElementsAre;

class WriteCalibrationTest : public testing::Test {
 protected:
  WriteCalibrationTest() { fs::remove(file_); }
  ~WriteCalibrationTest() override { fs::remove(file_); }

  /// The stage, which writes to file_.
  std::unique_ptr<Stage> make() const {
    const StageType type = describe_stage<WriteCalibrationStage>();
    auto stage = type.make();
    type.find_option("file")->set(type.options_object(*stage), OptionScalar(file_.string()));
    return stage;
  }

  static Calibration with_tau(double tau) {
    Calibration calibration = nominal_calibration(default_rig());
    calibration.lasers[1].tau.value = tau;
    return calibration;
  }

  fs::path file_ = fs::path(testing::TempDir()) / "crisp_write_calibration_test.yaml";
  RunSettings run_;
  StageReport report_;
  Context context_{run_, report_};
  Outputs nowhere_{[](const Item&) { FAIL() << "it gives nothing"; }};
};

TEST_F(WriteCalibrationTest, WritesTheLastCalibrationWhenTheRunIsOver) {
  const auto stage = make();
  for (const double tau : {0.1, 0.3}) {
    const std::vector<Item> items = {Item::of(std::make_shared<const Calibration>(with_tau(tau)))};
    stage->process(Inputs(items), nowhere_, context_);
  }
  EXPECT_FALSE(fs::exists(file_));
  stage->finish(nowhere_, context_);
  const Calibration written = read_calibration(file_);
  EXPECT_EQ(written.lasers.at(1).tau.value, 0.3);
  EXPECT_EQ(written.lasers.at(2).name, "laser3");
  EXPECT_EQ(written.provenance.at("crisp"), CRISP_VERSION);
  EXPECT_THAT(report_.written, ElementsAre(file_));
}

TEST_F(WriteCalibrationTest, WritesWhatTheStagesAboveUntrusted) {
  context_.set_caveats_above([] { return std::vector<std::string>{"the plate stood still"}; });
  const auto stage = make();
  const std::vector<Item> items = {Item::of(std::make_shared<const Calibration>(with_tau(0.2)))};
  stage->process(Inputs(items), nowhere_, context_);
  stage->finish(nowhere_, context_);
  EXPECT_THAT(read_calibration(file_).caveats, ElementsAre("the plate stood still"));
}

TEST_F(WriteCalibrationTest, ReportsThatNoCalibrationCame) {
  EXPECT_THROW(make()->finish(nowhere_, context_), Error);
  EXPECT_FALSE(fs::exists(file_));
}

}  // namespace
}  // namespace crisp
