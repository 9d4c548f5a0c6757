// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include <crisp/capture_reader.hpp>

#include "grabbers/record/capture_recorder.hpp"
#include "grabbers/wire/scan_encoding.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {

namespace fs = std::filesystem;

class CaptureRecorderTest : public testing::Test {
 protected:
  static std::vector<HubItem> read(const fs::path& file, bool ends_early = false) {
    CaptureReader reader(file, default_rig());
    std::vector<HubItem> items;
    while (auto item = reader.next()) items.push_back(std::move(*item));
    for (const auto& device : reader.statistics().devices) {
      if (ends_early) continue;  // within a telegram
      EXPECT_THAT(device.losses.all(), testing::Each(testing::Pair(testing::_, 0))) << device.name;
    }
    return items;
  }

  static void expect_same(const std::vector<HubItem>& read, const std::vector<HubItem>& written) {
    ASSERT_EQ(read.size(), written.size());
    for (std::size_t i = 0; i < read.size(); ++i) {
      ASSERT_EQ(receipt_ns(read[i]), receipt_ns(written[i])) << i;
      ASSERT_EQ(read[i].index(), written[i].index()) << i;
      if (const auto* scan = std::get_if<std::shared_ptr<const Scan>>(&read[i])) {
        const auto& other = std::get<std::shared_ptr<const Scan>>(written[i]);
        EXPECT_EQ((*scan)->laser, other->laser);
        EXPECT_EQ((*scan)->echoes.at(0).ranges, other->echoes.at(0).ranges);
        EXPECT_EQ(wire::to_scan_data(**scan), wire::to_scan_data(*other));
      } else {
        const auto& reading = std::get<PlateReading>(read[i]);
        const auto& other = std::get<PlateReading>(written[i]);
        EXPECT_EQ(reading.sequence, other.sequence);
        EXPECT_EQ(reading.device_us, other.device_us);
        EXPECT_EQ(reading.count, other.count);
      }
    }
  }

  test::TemporaryFolder folder_;
};

}  // namespace crisp
