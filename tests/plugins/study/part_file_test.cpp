// SPDX-License-Identifier: BSD-3-Clause
// Studies in parts: what is merged is what one machine computes, to the byte.
#include "plugins/study/part_file.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <list>
#include <set>

#include <crisp/error.hpp>

#include "plugins/study/basin_text.hpp"
#include "plugins/study/run_json.hpp"
#include "plugins/study/table.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::batch;
using namespace crisp::study;
namespace fs = std::filesystem;
using testing::HasSubstr;

/// A run with numbers that no short text holds.
MonteCarloTrial trial_of_seed(std::uint64_t seed) {
  const double third = static_cast<double>(seed) / 3;
  const Eigen::VectorXd numbers = Eigen::Vector3d(third, -0.0, 1e-300 * third);
  MonteCarloTrial trial{
      .seed = seed,
      .parameters = {"laser1.tau", "laser1.alpha", "laser1.eta"},
      .bound = numbers,
      .bound_with_steps = Eigen::Vector3d(third, std::numeric_limits<double>::quiet_NaN(), third),
      .rqe = {},
      .refined = {.error = numbers, .std_error = 2 * numbers, .failure = {}}};
  if (seed % 2 == 0) trial.rqe = Estimate{.error = numbers, .std_error = {}, .failure = {}};
  if (seed % 3 == 0) trial.refined = {.error = {}, .std_error = {}, .failure = "it \"failed\"\nä"};
  return trial;
}

class PartFileTest : public testing::Test {
 protected:
  static constexpr StudyExtent kExtent{.first_seed = 11, .runs = 8};

  /// A context of a run, which lives as long as the test.
  Context& context(const fs::path& output) {
    auto& run = runs_.emplace_back();
    run.output = output;
    return contexts_.emplace_back(run, report_);
  }

  /// Does a part as a stage does, and counts the runs that are computed.
  std::vector<MonteCarloTrial> do_part(std::size_t number, std::size_t count,
                                       const std::string& key = "abc") {
    const Shard shard{number, count};
    const StudyPart part{.part = shard.text(), .merge = {}, .key = key};
    const fs::path output = folder_ / (std::to_string(number) + "-of-" + std::to_string(count));
    fs::create_directories(output);
    Context& own = context(output);
    auto trials = run_or_read<MonteCarloTrial>(
        own, part, kExtent,
        [&] {
          std::vector<MonteCarloTrial> made;
          for (std::size_t k = 0; k < share_of(shard, kExtent.runs); ++k)
            made.push_back(trial_of_seed(kExtent.first_seed + run_of(shard, k)));
          computed_ += made.size();
          return made;
        },
        trial_of);
    EXPECT_TRUE(write_if_part(own, part, kExtent, trials, trial_json));
    return trials;
  }

  std::vector<MonteCarloTrial> merge(const std::string& key = "abc") {
    const StudyPart part{.part = {}, .merge = folder_.path(), .key = key};
    Context& own = context(folder_.path());
    const auto none = [] { return std::vector<MonteCarloTrial>(); };
    auto trials = run_or_read<MonteCarloTrial>(own, part, kExtent, none, trial_of);
    EXPECT_FALSE(write_if_part(own, part, kExtent, trials, trial_json));
    return trials;
  }

  test::TemporaryFolder folder_;
  std::size_t computed_ = 0;

 private:
  std::list<RunSettings> runs_;
  std::list<Context> contexts_;
  StageReport report_;
};

TEST(StudyPart, TakesEachRunOnce) {
  for (const std::size_t total : {0, 1, 5, 6, 7, 100}) {
    std::multiset<std::size_t> taken;
    for (std::size_t number = 1; number <= 6; ++number) {
      const Shard part{number, 6};
      for (std::size_t k = 0; k < share_of(part, total); ++k) taken.insert(run_of(part, k));
    }
    EXPECT_EQ(taken.size(), total);
    EXPECT_EQ(std::set<std::size_t>(taken.begin(), taken.end()).size(), total) << "of " << total;
    EXPECT_TRUE(total == 0 || *taken.rbegin() == total - 1);
  }
}

TEST_F(PartFileTest, MergesToTheBytesOfOneMachine) {
  std::vector<MonteCarloTrial> all;
  for (std::uint64_t seed = 11; seed < 19; ++seed) all.push_back(trial_of_seed(seed));
  for (std::size_t number = 1; number <= 3; ++number) do_part(number, 3);
  const auto merged = merge();
  ASSERT_EQ(merged.size(), 8U);
  EXPECT_EQ(runs_csv(merged), runs_csv(all));
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(trial_json(merged[i]), trial_json(all[i]));
    EXPECT_EQ(std::signbit(merged[i].bound[1]), std::signbit(all[i].bound[1]));
    EXPECT_EQ(merged[i].bound[2], all[i].bound[2]);
    EXPECT_TRUE(std::isnan(merged[i].bound_with_steps[1]));
  }
}

TEST_F(PartFileTest, DoesNoPartTwiceOfTheSameKey) {
  do_part(2, 3);
  EXPECT_EQ(computed_, 3U);
  EXPECT_EQ(runs_csv(do_part(2, 3)), runs_csv({trial_of_seed(12), trial_of_seed(15), trial_of_seed(18)}));
  EXPECT_EQ(computed_, 3U);
  do_part(2, 3, "other");
  EXPECT_EQ(computed_, 6U);
}

TEST_F(PartFileTest, NamesMissingRuns) {
  do_part(1, 3);
  do_part(3, 3);
  try {
    merge();
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.message(), HasSubstr("3 runs of the study are missing in "));
    EXPECT_THAT(error.message(), HasSubstr("the first has the seed 12"));
  }
}

TEST_F(PartFileTest, RefusesPartsOfAnotherKeyAndDamagedOnes) {
  for (std::size_t number = 1; number <= 3; ++number) do_part(number, 3);
  EXPECT_THROW(merge("other"), Error);
  const fs::path file = folder_ / "2-of-3/part.json";
  fs::resize_file(file, fs::file_size(file) / 2);
  EXPECT_THROW(merge(), Error);
  do_part(2, 3);
  EXPECT_EQ(merge().size(), 8U) << "a damaged part is done again";
}

TEST_F(PartFileTest, KeepsABasinToTheBit) {
  const BasinRecording recording{.seed = 7,
                                 .parameters = {"laser1.tau"},
                                 .starts = {{.recording = 7,
                                             .start = {0.1},
                                             .ending = Ending::kSilent,
                                             .off = 1.0 / 3,
                                             .farthest = "laser1.tau",
                                             .error = -1.0 / 7,
                                             .caveats = {}},
                                            {.recording = 7,
                                             .start = {0.2},
                                             .ending = Ending::kWithCaveats,
                                             .off = std::numeric_limits<double>::infinity(),
                                             .farthest = {},
                                             .error = 0,
                                             .caveats = {"a", "b"}}},
                                 .caveats = {"c"},
                                 .failure = {}};
  const auto again = basin_of(nlohmann::json::parse(basin_json(recording).dump()));
  EXPECT_EQ(basin_csv({again}), basin_csv({recording}));
  EXPECT_EQ(basin_text({again}), basin_text({recording}));
  EXPECT_EQ(again.starts[0].off, recording.starts[0].off);
  EXPECT_EQ(again.caveats, recording.caveats);
}

}  // namespace
}  // namespace crisp
