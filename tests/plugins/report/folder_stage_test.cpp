// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/report/folder_stage.hpp"

#include <gmock/gmock.h>

#include <crisp/atomic_file.hpp>
#include <crisp/calibration_file.hpp>
#include <crisp/cloud_conversion.hpp>
#include <crisp/error.hpp>

#include "tests/support/stage_driver.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::report;
using test::StageDriver;
using test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using Json = nlohmann::ordered_json;

class FolderReport : public testing::Test {
 protected:
  /// Runs the stage, and reads the data of the page that it writes.
  Json data_of_report() {
    StageDriver driver =
        StageDriver::of<FolderReportStage>({{"folder", OptionScalar(folder_.path().string())}});
    driver.feed();
    EXPECT_THAT(driver.report().written, ElementsAre(folder_ / "report.html"));
    const std::string page = test::bytes_of(folder_ / "report.html");
    const std::string begin = R"(id="report-data">)";
    const auto from = page.find(begin) + begin.size();
    return Json::parse(page.substr(from, page.find("</script>", from) - from));
  }

  std::string failure_of_report() {
    StageDriver driver =
        StageDriver::of<FolderReportStage>({{"folder", OptionScalar(folder_.path().string())}});
    try {
      driver.feed();
    } catch (const Error& error) {
      return error.message();
    }
    return {};
  }

  TemporaryFolder folder_;
};

TEST_F(FolderReport, OfARunHoldsWhatTheFolderHolds) {
  test::put_bytes(folder_ / "summary.json", R"({"trusted": true, "stages": []})");
  write_calibration(folder_ / "calibration.yaml", nominal_calibration(default_rig()));
  Cloud cloud;
  cloud.resize(20);
  AtomicFile file(folder_ / "cloud.pcd");
  write_pcd(file, to_pcd_table(cloud), PcdFormat::binary);
  file.commit();
  test::put_bytes(folder_ / "diagnosis.json", R"({"findings": []})");
  const Json data = data_of_report();
  EXPECT_EQ(data.at("kind"), "run");
  EXPECT_EQ(data.at("calibration").at("parameters").size(), 12U);
  EXPECT_EQ(data.at("cloud").at("points"), 20);
  EXPECT_TRUE(data.contains("findings"));
}

TEST_F(FolderReport, OfARunThatFailedHoldsItsError) {
  test::put_bytes(folder_ / "summary.json", R"({"trusted": false, "error": "no beam", "stages": []})");
  const Json data = data_of_report();
  EXPECT_EQ(data.at("summary").at("error"), "no beam");
  EXPECT_FALSE(data.contains("calibration"));
}

TEST_F(FolderReport, FindsPlotsThatWereMovedWithTheFolder) {
  test::put_bytes(folder_ / "summary.json", R"({"stages": [{"outputs": ["/elsewhere/laser1_noise.svg"]}]})");
  test::put_bytes(folder_ / "laser1_noise.svg", "<svg/>");
  EXPECT_EQ(data_of_report().at("plots").size(), 1U);
}

TEST_F(FolderReport, OfABatchLeadsToTheReportsOfItsRuns) {
  test::put_bytes(folder_ / "batch.json", R"({"rows": [{"name": "a/one"}, {"name": "two"}]})");
  std::filesystem::create_directories(folder_ / "a/one");
  test::put_bytes(folder_ / "a/one/report.html", "x");
  const Json data = data_of_report();
  EXPECT_EQ(data.at("kind"), "batch");
  EXPECT_EQ(data.at("batch").at("rows").at(0).at("report"), "a/one/report.html");
  EXPECT_FALSE(data.at("batch").at("rows").at(1).contains("report"));
}

TEST_F(FolderReport, RefusesAFolderOfNeither) {
  EXPECT_THAT(failure_of_report(), HasSubstr("holds neither summary.json nor batch.json"));
}

TEST_F(FolderReport, RefusesASummaryThatIsDamaged) {
  test::put_bytes(folder_ / "summary.json", R"({"stages": )");
  EXPECT_THAT(failure_of_report(), HasSubstr("summary.json is damaged"));
}

TEST_F(FolderReport, RefusesASummaryThatIsSomethingElse) {
  test::put_bytes(folder_ / "summary.json", R"([1, 2])");
  EXPECT_THAT(failure_of_report(), HasSubstr("summary.json is damaged"));
}

}  // namespace
}  // namespace crisp
