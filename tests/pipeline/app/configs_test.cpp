// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "pipeline/files/yaml.hpp"
#include "tests/support/source_dir.hpp"

namespace crisp {
namespace {

namespace fs = std::filesystem;

bool is_pipeline(const fs::path& file) {
  return file.extension() == ".yaml" && read_yaml(file).find("pipeline") != nullptr;
}

TEST(Configs, AreRight) {
  int pipelines = 0;
  for (const auto& entry : fs::recursive_directory_iterator(source_dir() + "/configs")) {
    if (!is_pipeline(entry.path())) continue;
    ++pipelines;
    // Neither errors nor warnings.
    const std::string told = CRISP_PROGRAM " validate " + entry.path().string() + " 2>&1 >/dev/null";
    EXPECT_EQ(std::system(("told=$(" + told + ") && test -z \"$told\"").c_str()), 0) << entry.path();
  }
  EXPECT_GT(pipelines, 0);
}

}  // namespace
}  // namespace crisp
