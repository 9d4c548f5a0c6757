// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/batch/ledger.hpp"

#include <gmock/gmock.h>

#include <crisp/atomic_file.hpp>

#include "pipeline/batch/plan.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::batch;

using Kind = BatchEventKind;

BatchEvent event(Kind kind, std::int64_t time, JobStatus status = JobStatus::done,
                 const std::string& settings = "now") {
  return {.kind = kind, .time = time, .name = "r", .status = status, .settings = settings};
}

/// Why the recording is due after these events of two tasks.
DueReason due_after(const std::vector<BatchEvent>& one, const std::vector<BatchEvent>& other = {}) {
  BatchLedger ledger;
  for (const auto& each : one) ledger.add(each, "one");
  for (const auto& each : other) ledger.add(each, "other");
  return due_reason(ledger.find("r"), "now");
}

TEST(Ledger, ReportsWhyARecordingIsDue) {
  const auto ended = [](JobStatus status, const std::string& settings = "now") {
    return std::vector<BatchEvent>{event(Kind::start, 1), event(Kind::end, 2, status, settings)};
  };
  EXPECT_EQ(due_after({}), DueReason::fresh);
  EXPECT_EQ(due_after({event(Kind::start, 1)}), DueReason::half_done);
  EXPECT_EQ(due_after(ended(JobStatus::done)), DueReason::none);
  EXPECT_EQ(due_after(ended(JobStatus::untrusted)), DueReason::none);
  EXPECT_EQ(due_after(ended(JobStatus::failed)), DueReason::none) << "it would fail again";
  EXPECT_EQ(due_after(ended(JobStatus::interrupted)), DueReason::interrupted);
  EXPECT_EQ(due_after(ended(JobStatus::done, "then")), DueReason::settings);
}

TEST(Ledger, CountsTheLastEventWhicheverTaskWroteIt) {
  const std::vector<BatchEvent> done = {event(Kind::start, 1), event(Kind::end, 2)};
  EXPECT_EQ(due_after(done, {event(Kind::start, 3)}), DueReason::half_done);
  EXPECT_EQ(due_after({event(Kind::start, 3)}, done), DueReason::half_done);
  EXPECT_EQ(due_after({event(Kind::start, 1)}, {event(Kind::start, 2), event(Kind::end, 4)}),
            DueReason::none);
  EXPECT_EQ(due_after({event(Kind::end, 5, JobStatus::interrupted)}, done), DueReason::interrupted);
  EXPECT_EQ(due_after(done, {event(Kind::end, 5, JobStatus::interrupted)}), DueReason::interrupted);
}

TEST(Ledger, TriesAgainOnceForEachTimeThatIsRequested) {
  const std::vector<BatchEvent> failed = {event(Kind::start, 1), event(Kind::end, 2, JobStatus::failed)};
  EXPECT_EQ(due_after(failed, {event(Kind::retry, 3)}), DueReason::retry);
  EXPECT_EQ(due_after(failed, {event(Kind::retry, 3), event(Kind::end, 4, JobStatus::failed)}),
            DueReason::none);
}

class PlanTest : public testing::Test {
 protected:
  PlanTest() { write_file(folder_ / "r.pcap", "content"); }

  BatchInput input() const { return {.name = "r", .path = (folder_ / "r.pcap").string()}; }
  BatchPlan plan(const BatchLedger& ledger) const {
    return plan_batch({input()}, ledger, "now", [](const BatchInput&) { return std::filesystem::path(); });
  }
  /// A recording that was done with its present input, but for this change.
  template <class Change>
  BatchLedger done_with(Change change) const {
    auto files = input_files(input(), {});
    // From `printf content | sha256sum`.
    files[0].sha256 = "ed7002b439e9ac845f22357d822bac1444730fbdb6016d3ec9432297b9ec9f73";
    change(files[0]);
    BatchLedger ledger;
    BatchEvent end = event(Kind::end, 2);
    end.input = files;
    ledger.add(end, "one");
    return ledger;
  }

  test::TemporaryFolder folder_;
};

TEST_F(PlanTest, LeavesWhatIsUnchanged) {
  const auto unchanged = plan(done_with([](InputFile&) {}));
  EXPECT_TRUE(unchanged.due.empty());
  EXPECT_EQ(unchanged.kept.at(JobStatus::done), 1U);
}

TEST_F(PlanTest, DistinguishesChangedContentFromAChangedTime) {
  const auto touched = plan(done_with([](InputFile& file) { file.mtime -= 1; }));
  EXPECT_TRUE(touched.due.empty());
  ASSERT_EQ(touched.touched.size(), 1U);
  EXPECT_EQ(touched.touched[0].files[0].mtime, input_files(input(), {})[0].mtime);
  EXPECT_FALSE(touched.touched[0].files[0].sha256.empty());
  const auto changed = plan(done_with([](InputFile& file) {
    file.mtime -= 1;
    file.sha256.front() = '0';
  }));
  EXPECT_EQ(changed.reasons.at(DueReason::input), 1U);
  EXPECT_EQ(plan(done_with([](InputFile& file) { file.bytes += 1; })).reasons.count(DueReason::input), 1U);
  const auto unknown = plan(done_with([](InputFile& file) {
    file.mtime -= 1;
    file.sha256.clear();
  }));
  EXPECT_EQ(unknown.reasons.count(DueReason::input), 1U) << "as it is not known to be the same";
}

TEST_F(PlanTest, LeavesAFailedInputThatStillCannotBeRead) {
  BatchLedger ledger;
  ledger.add(event(Kind::end, 2, JobStatus::failed), "one");
  auto missing = input();
  missing.path += ".gone";
  const auto no_rig = [](const BatchInput&) { return std::filesystem::path(); };
  EXPECT_TRUE(plan_batch({missing}, ledger, "now", no_rig).due.empty());
  EXPECT_EQ(plan(ledger).reasons.count(DueReason::input), 1U) << "now that it is there";
}

}  // namespace
}  // namespace crisp
