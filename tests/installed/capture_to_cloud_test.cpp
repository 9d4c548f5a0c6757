// SPDX-License-Identifier: BSD-3-Clause
// The example is run as a user runs it, on what the program simulated.
#include <gtest/gtest.h>

#include <cstdlib>

#include <crisp/pcd_table.hpp>

#include "tests/support/source_dir.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

TEST(CaptureToCloud, MakesTheCloudThatTheProgramMakes) {
  const test::TemporaryFolder folder;
  const std::string made = (folder / "made").string();
  const std::string out = (folder / "out").string();
  const std::string mine = (folder / "mine.pcd").string();
  const std::string capture = made + "/hub.pcap";
  const std::string truth = made + "/truth.yaml";
  const auto run = [](const std::string& command) { return std::system((command + " >/dev/null").c_str()); };
  const std::string crisp_run = CRISP_PROGRAM " run --quiet " + source_dir() + "/configs/";
  ASSERT_EQ(run(crisp_run + "simulate.yaml -o " + made + " --set grabber.simulate.duration=2s"), 0);
  ASSERT_EQ(run(crisp_run + "assemble.yaml -i " + capture + " -o " + out + " --set calibration=" + truth), 0);
  ASSERT_EQ(run(CAPTURE_TO_CLOUD " " + capture + " " + truth + " " + mine), 0);
  const PcdTable cloud = read_pcd(mine);
  EXPECT_GT(cloud.rows(), 100000U);
  EXPECT_EQ(cloud.bytes(), read_pcd(out + "/cloud.pcd").bytes());
}

}  // namespace
}  // namespace crisp
