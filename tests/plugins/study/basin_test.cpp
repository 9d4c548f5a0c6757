// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/study/basin.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include <crisp/error.hpp>

#include "plugins/study/basin_text.hpp"
#include "tests/plugins/study/rqe.hpp"

namespace crisp {
namespace {

using namespace crisp::study;
using testing::HasSubstr;

using test::make_rqe;

BasinSettings few_starts(std::size_t starts) {
  BasinSettings settings;
  settings.trial.lasers = 2;
  settings.trial.duration = 5;
  settings.trial.rqe.probes = 4;
  settings.starts = starts;
  settings.starts_per_recording = 2;
  return settings;
}

TEST(Basin, DrawsStartsOverTheWholeRangeAndEndsInTheSameOptimum) {
  BasinSettings settings = few_starts(4);
  const auto recordings = explore_basin(settings, make_rqe);
  ASSERT_EQ(recordings.size(), 2U);
  EXPECT_EQ(tally_of(recordings).starts, 4U);
  EXPECT_EQ(tally_of(recordings).same, 4U) << basin_text(recordings);
  for (const BasinRecording& recording : recordings) {
    ASSERT_EQ(recording.parameters.size(), 7U);
    EXPECT_EQ(recording.parameters[3], "laser2.lambda");
    for (const BasinStart& start : recording.starts) {
      for (const int tau : {0, 4}) {
        EXPECT_GE(start.start[static_cast<std::size_t>(tau)], 0);
        EXPECT_LE(start.start[static_cast<std::size_t>(tau)], 0.5);
      }
    }
    EXPECT_NE(recording.starts[0].start, recording.starts[1].start);
  }
  settings.threads = 2;
  EXPECT_EQ(basin_csv(explore_basin(settings, make_rqe)), basin_csv(recordings)) << "on two threads";
}

TEST(Basin, ReportsWhyARecordingHasNoStarts) {
  BasinSettings settings = few_starts(2);
  settings.trial.motion.max_rate = 0;
  const auto recordings = explore_basin(settings, make_rqe);
  ASSERT_EQ(recordings.size(), 1U);
  EXPECT_THAT(recordings[0].failure, HasSubstr("no flat surface"));
  EXPECT_EQ(tally_of(recordings).failed, 1U);
}

TEST(Basin, CountsEndsByTheirCaveats) {
  BasinRecording recording{.seed = 7, .parameters = {"laser1.tau"}};
  recording.starts = {
      {.recording = 7, .start = {0.3}, .ending = Ending::kSame, .off = 0.1, .farthest = "laser1.tau"},
      {.recording = 7, .start = {0.1}, .ending = Ending::kSame, .caveats = {"it is dark"}},
      {.recording = 7, .start = {0.2}, .ending = Ending::kWithCaveats, .off = 9, .caveats = {"a \"wall\""}},
      {.recording = 7,
       .start = {0},
       .ending = Ending::kSilent,
       .off = 20,
       .farthest = "laser1.tau",
       .error = 0.05}};
  const BasinTally tally = tally_of({recording});
  EXPECT_EQ(tally.starts, 4U);
  EXPECT_EQ(tally.same, 2U);
  EXPECT_EQ(tally.same_with_caveats, 1U);
  EXPECT_EQ(tally.with_caveats, 1U);
  EXPECT_EQ(tally.silent, 1U);
  const std::string text = basin_text({recording});
  EXPECT_THAT(text,
              HasSubstr("recording 7 start 3: laser1.tau off by 50 mm, 20 standard errors; without caveats"));
  EXPECT_THAT(text, HasSubstr("elsewhere, without caveats                          1   25.00 %"));
  EXPECT_THAT(basin_csv({recording}), HasSubstr("7,2,laser1.tau,m,0.2,caveats,9,,0,\"a 'wall'\"\n"));
}

}  // namespace
}  // namespace crisp
