// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/end_to_end/pipeline_fixture.hpp"
#include "tests/support/shared_data.hpp"

namespace crisp::test {

/// Runs pipelines of configs/real on recordings that are shared, but not in the repository.
class OnRealData : public testing::Test {
 protected:
  /// False for a recording that is not at hand: the test is skipped, and only has to return.
  static bool at_hand(const std::filesystem::path& recording) {
    if (std::filesystem::exists(shared_data() / recording)) return true;
    skip(shared_data() / recording);
    return false;
  }

  /// Runs a diagnosis, configs/real/`config`, on a recording, into the folder out; false as at_hand().
  bool run(const std::string& config, const std::string& recording,
           const std::vector<std::string>& set = {}) {
    if (!at_hand(recording)) return false;
    outcome_ = fixture_.run("real/" + config, shared_data() / recording, "out", set);
    EXPECT_EQ(outcome_.status, app::ExitStatus::done) << outcome_.console;
    diagnosis_ = nlohmann::json::parse(bytes_of(fixture_ / "out/diagnosis.json"));
    return true;
  }

  /// The one finding of a cause, or null.
  nlohmann::json finding(const std::string& cause) const {
    for (const auto& each : diagnosis_["findings"]) {
      if (each["cause"] == cause) return each;
    }
    return {};
  }

  const PipelineFixture fixture_;
  Outcome outcome_;           // of the last run
  nlohmann::json diagnosis_;  // likewise

 private:
  static void skip(const std::filesystem::path& file) {
    GTEST_SKIP() << file.string() << " is missing; CRISP_SHARED_DATA names the folder of the data";
  }
};

}  // namespace crisp::test
