// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

#include <crisp/measurements.hpp>
#include <crisp/pipeline.hpp>
#include <crisp/plate_trajectory.hpp>
#include <crisp/runner.hpp>

#include "grabbers/table/register.hpp"
#include "tests/support/source_dir.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::table;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::Pair;

class TableStageTest : public testing::Test {
 protected:
  void SetUp() override {
    register_table(registrar_);
    run_.registrar = &registrar_;
  }

  NodeResult run(const std::string& table, const std::string& options) {
    std::ofstream(folder_ / "t.csv") << table;
    std::ofstream(folder_ / "pipeline.yaml")
        << "crisp: 1\nrig: " << rig_
        << "\npipeline:\n  - stage: grabber.table\n    with: {file: " << (folder_ / "t.csv").string() << ", "
        << options << "}\n";
    auto loaded = load_pipeline(folder_ / "pipeline.yaml", {}, run_);
    return run_pipeline(loaded.pipeline, run_, hooks_).at(0);
  }
  std::string complaint(const std::string& table, const std::string& options) {
    try {
      run(table, options);
    } catch (const Error& error) {
      return error.what();
    }
    return "nothing";
  }

  test::TemporaryFolder folder_;
  Registrar registrar_;
  RunSettings run_;
  RunHooks hooks_;
  std::string rig_ = "{crisp: 1, lasers: {a: {nominal: {lambda: 0, tau: 0}}}, plate: {}}";
};

constexpr const char* kColumns = "time_column: 1, angle_column: 2, range_column: 3, angle_step: 1deg";

TEST_F(TableStageTest, ReportsReadAndDroppedRows) {
  const auto result = run("0,0,1,2\n1,0,x\n2,0,1,0\n", kColumns);
  EXPECT_EQ(result.report.section["rows"], 2);
  EXPECT_EQ(result.report.section["beams"], 3);
  EXPECT_THAT(result.report.counts, ElementsAre(Pair("rows with a field that is no number", 1)));
  EXPECT_THAT(result.report.warnings,
              ElementsAre(HasSubstr("t.csv:2:5: here is the first of the rows with")));
}

TEST_F(TableStageTest, GivesALongTableInPiecesInWhichEachBeamIsPlaced) {
  constexpr int kRows = 2500;
  constexpr double kInterval = 0.01, kRate = 0.5;  // [s], [rad/s]
  std::string ranges;
  for (int i = 0; i < 1000; ++i) ranges += ",1";
  std::string table;
  for (int k = 0; k < kRows; ++k)
    table += fmt::format("{},{}{}\n", k * kInterval, k * kInterval * kRate, ranges);
  std::shared_ptr<const PlateTrajectory> plate;
  std::size_t pieces = 0, beams = 0, unplaced = 0;
  double worst = 0;
  hooks_.given = [&](const std::string&, const Item& item) {
    if (auto piece = item.as<PlateTrajectory>()) {
      plate = std::move(piece);
      ++pieces;
    }
    const auto scan = item.as<Measurements>();
    if (!scan) return;
    beams += scan->size();
    const auto state = plate ? plate->at(scan->time.front()) : std::nullopt;
    if (!state) unplaced += scan->size();
    if (state) worst = std::max(worst, std::abs(state->angle - kRate * scan->time.front()));
  };
  run(table, "time_column: 1, angle_column: 2, angle_unit: rad, range_column: 3, angle_step: 0.1deg");
  EXPECT_EQ(pieces, 3U);
  EXPECT_EQ(beams, 1000U * kRows);
  EXPECT_EQ(unplaced, 0U);
  EXPECT_LT(worst, 2 * std::numbers::pi / 16384);  // a step of the encoder
}

TEST_F(TableStageTest, ReadsAPartOfTheTable) {
  const auto result =
      run("0,0,1\n1,0,1\n2,0,1\n3,0,1\n", std::string(kColumns) + ", begin: 1s, duration: 2s");
  EXPECT_EQ(result.report.section["beams"], 2);
  EXPECT_THAT(result.report.counts, ElementsAre(Pair("rows outside of begin and duration", 2)));
}

TEST_F(TableStageTest, ALaserThatStandsStillHasNoReadings) {
  const auto result = run("0,1,2\n1,1,2\n2,1,2\n", "time_column: 1, range_column: 2, angle_step: 1deg");
  EXPECT_EQ(result.report.section["beams"], 6);
  EXPECT_THAT(result.given, Contains(Pair("Scan", 3)));
  EXPECT_THAT(result.given, Not(Contains(Pair("PlateReading", testing::_))));
}

TEST_F(TableStageTest, ReadsTimesAlone) {
  const auto result = run("0,5\n1,6\n2,7\n", "time_column: 1, receipt_column: 2");
  EXPECT_EQ(result.report.section["rows"], 3);
  EXPECT_THAT(result.given, ElementsAre(Pair("Scan", 3)));
  EXPECT_THAT(complaint("# nothing\n", "time_column: 1"), HasSubstr("holds no row"));
}

TEST_F(TableStageTest, RefusesWhatHoldsNothingWithThePlaceOfTheFirstFault) {
  EXPECT_THAT(complaint("# nothing\n", kColumns), HasSubstr("holds no range"));
  EXPECT_THAT(complaint("\n0,0\n", kColumns), HasSubstr("t.csv:2:4"));
  EXPECT_THAT(complaint("0,0,1\n", kColumns), HasSubstr("fewer than two angles"));
}

TEST_F(TableStageTest, RefusesAnEmptyFileAndDecimalCommas) {
  EXPECT_THAT(complaint("", kColumns), HasSubstr("t.csv is empty"));
  EXPECT_THAT(complaint("t;a;r\n0,5;0;1,25\n", kColumns), HasSubstr("t.csv:2:2: error"));
  EXPECT_THAT(complaint("0\t0\t1,25\n", kColumns), HasSubstr("decimal commas"));
  for (const auto* whole : {" 1000,512\n 2000,513\n", "1000,512 \n2000,513 \n", "1000,512;\n2000,513;\n"}) {
    EXPECT_THAT(complaint(whole, "time_column: 1, angle_column: 2"), Not(HasSubstr("decimal commas")))
        << whole;
  }
  EXPECT_THAT(complaint("0;0;1,2,3\n1;0;1,2,3\n", kColumns), "nothing") << "commas between ranges";
  EXPECT_THAT(complaint("0, 0, 1, 2\n1, 0, 1, 2\n", kColumns), "nothing");
}

TEST_F(TableStageTest, RefusesOptionsThatLeaveATimeOrAnAngleUnknown) {
  EXPECT_THAT(complaint("", "angle_column: 1, range_column: 2, angle_step: 1deg"),
              HasSubstr("give time_column"));
  EXPECT_THAT(complaint("", "time_column: 1, remission_column: 3"), HasSubstr("give range_column"));
  EXPECT_THAT(complaint("", "time_column: 1, angle_column: 2, range_column: 3"),
              HasSubstr("give angle_step"));
  EXPECT_THAT(
      complaint("", "time_column: 3, counter_column: 4, angle_column: 1, range_column: 2, angle_step: 1deg"),
      HasSubstr("give the period"));
  rig_ = source_dir() + "/configs/rig.yaml";
  EXPECT_THAT(complaint("", kColumns), HasSubstr("give laser_column"));
}

TEST_F(TableStageTest, AColumnHasOneMeaning) {
  EXPECT_THAT(complaint("", "time_column: 1, angle_column: 1, range_column: 1, angle_step: 1deg"),
              HasSubstr("time_column and angle_column are both 1"));
  EXPECT_THAT(complaint("", std::string(kColumns) + ", remission_column: 3"), HasSubstr("are both 3"));
  EXPECT_EQ(run("0,0,1\n1,0,1\n", std::string(kColumns) + ", receipt_column: 1").report.section["beams"], 2);
}

TEST_F(TableStageTest, ReadsAPartOfATableThatOnlyThePeriodTimes) {
  const auto result =
      run("0,1\n0,1\n0,1\n0,1\n",
          "angle_column: 1, range_column: 2, angle_step: 1deg, period: 1s, begin: 1s, duration: 2s");
  EXPECT_EQ(result.report.section["beams"], 2);
  EXPECT_THAT(result.report.counts, ElementsAre(Pair("rows outside of begin and duration", 2)));
}

TEST_F(TableStageTest, ReportsWhereTheRowsFirstAreOutOfOrder) {
  const auto result = run("0,0,1\n1,0,1\n90,0,1\n2,0,1\n3,0,1\n", kColumns);
  EXPECT_THAT(result.report.counts, ElementsAre(Pair("rows that are earlier than the row before", 2)));
  EXPECT_EQ(result.report.section["rows"], 3) << "what is left out is no row that was read";
  EXPECT_THAT(result.report.warnings,
              ElementsAre(HasSubstr("t.csv:4:1: here is the first of the rows that are")));
}

TEST_F(TableStageTest, RowsBeforeTheFirstAreNotLeftOutBecauseOfBegin) {
  const auto result = run("5,0,1\n4,0,1\n6,0,1\n", kColumns);
  EXPECT_THAT(result.report.counts, ElementsAre(Pair("rows that are earlier than the row before", 1)));
}

TEST_F(TableStageTest, WarnsWhereTheBeamsOfARowLastBeyondTheNext) {
  const std::string table = "0,0,1,1,1\n1,0,1,1,1\n2,0,1,1,1\n3,0,1,1,1\n";
  EXPECT_THAT(run(table, std::string(kColumns) + ", beam_interval: 0.4s").report.warnings,
              testing::IsEmpty());
  EXPECT_THAT(run(table, std::string(kColumns) + ", beam_interval: 0.6s").report.warnings,
              ElementsAre(HasSubstr("3 of 4 rows begin before the last beam")));
  EXPECT_THAT(
      run(table, "receipt_column: 1, angle_column: 2, range_column: 3, angle_step: 1deg, beam_interval: 0.6s")
          .report.warnings,
      testing::IsEmpty())
      << "receipts come in bursts";
}

TEST_F(TableStageTest, WarnsOfCountsThatAreTakenForRadians) {
  const std::string table = "0,0,1\n1,20,1\n2,41,1\n3,60,1\n";
  EXPECT_THAT(run(table, kColumns).report.warnings,
              Contains(HasSubstr("3 of 4 angles are a turn and a half")));
  EXPECT_THAT(run(table, std::string(kColumns) + ", angle_unit: counts").report.warnings, testing::IsEmpty());
  EXPECT_THAT(run("0,6.2,1\n1,0.1,1\n2,0.2,1\n", kColumns).report.warnings, testing::IsEmpty())
      << "it begins anew at a whole turn";
}

TEST_F(TableStageTest, RefusesAFolder) {
  std::ofstream(folder_ / "pipeline.yaml")
      << "crisp: 1\nrig: " << rig_
      << "\npipeline:\n  - stage: grabber.table\n    with: {file: " << (folder_ / ".").string() << ", "
      << kColumns << "}\n";
  auto loaded = load_pipeline(folder_ / "pipeline.yaml", {}, run_);
  try {
    run_pipeline(loaded.pipeline, run_, {});
    ADD_FAILURE() << "it was read";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("is a folder"));
  }
}

}  // namespace
}  // namespace crisp
