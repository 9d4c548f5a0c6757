// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/batch/slurm_environment.hpp"

#include <gtest/gtest.h>

#include <map>
#include <string>

#include <crisp/error.hpp>

namespace crisp {
namespace {

using namespace crisp::batch;

std::map<std::string, const char*> environment;

const char* variable(const char* name) {
  const auto found = environment.find(name);
  return found == environment.end() ? nullptr : found->second;
}

std::optional<Shard> of_slurm(std::map<std::string, const char*> variables) {
  environment = std::move(variables);
  return shard_of_slurm(variable);
}

TEST(SlurmEnvironment, NumbersTheTasksOfAnArrayFromItsFirst) {
  EXPECT_FALSE(of_slurm({}));
  const auto third = of_slurm({{"SLURM_ARRAY_TASK_ID", "12"},
                               {"SLURM_ARRAY_TASK_MIN", "10"},
                               {"SLURM_ARRAY_TASK_COUNT", "6"},
                               {"SLURM_ARRAY_TASK_STEP", "1"}});
  ASSERT_TRUE(third);
  EXPECT_EQ(third->text(), "3/6");
  const auto stepped = of_slurm({{"SLURM_ARRAY_TASK_ID", "20"},
                                 {"SLURM_ARRAY_TASK_MIN", "0"},
                                 {"SLURM_ARRAY_TASK_COUNT", "3"},
                                 {"SLURM_ARRAY_TASK_STEP", "10"}});
  ASSERT_TRUE(stepped);
  EXPECT_EQ(stepped->text(), "3/3");
  EXPECT_THROW(
      of_slurm(
          {{"SLURM_ARRAY_TASK_ID", "9"}, {"SLURM_ARRAY_TASK_MIN", "1"}, {"SLURM_ARRAY_TASK_COUNT", "3"}}),
      Error)
      << "an array with gaps";
}

TEST(SlurmEnvironment, ReportsTheCoresOfATask) {
  environment = {};
  EXPECT_FALSE(cores_of_slurm(variable));
  environment = {{"SLURM_CPUS_ON_NODE", "12"}};
  EXPECT_EQ(cores_of_slurm(variable), 12U);
  for (const char* wrong : {"", "0", "-1", "4(x2)"}) {
    environment = {{"SLURM_CPUS_ON_NODE", wrong}};
    EXPECT_FALSE(cores_of_slurm(variable)) << wrong;
  }
}

}  // namespace
}  // namespace crisp
