// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/read_ahead.hpp"

#include <gtest/gtest.h>

#include <crisp/error.hpp>

#include "tests/grabbers/capture/scenario.hpp"
#include "tests/grabbers/capture/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::capture;

/// A capture of some thousand items: more than one batch.
class ReadAheadTest : public testing::Test {
 protected:
  void SetUp() override {
    scenario_.scans = 2000;
    write_file(file_, pcap_file(scenario_.frames()));
  }

  Scenario scenario_;
  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "hub.pcap";
};

template <class Next>
std::vector<std::string> all_items(Next next) {
  std::vector<std::string> items;
  for (ReadBatch batch = next(); !batch.items.empty(); batch = next()) {
    for (const auto& received : batch.items) {
      items.push_back(describe(received.item) + " since " + std::to_string(received.first_ns));
    }
    items.push_back("progress " + std::to_string(batch.progress));
  }
  return items;
}

TEST_F(ReadAheadTest, GivesWhatReadingInTurnGives) {
  CaptureReader one(file_, default_rig());
  CaptureReader other(file_, default_rig());
  const auto in_turn = all_items([&] { return read_batch(one); });
  ReadAhead ahead(other);
  EXPECT_EQ(all_items([&] { return ahead.next(); }), in_turn);
  EXPECT_GT(in_turn.size(), 2000U);
  EXPECT_EQ(other.statistics().packets, one.statistics().packets);
}

TEST_F(ReadAheadTest, EndsWhenNobodyTakesAnyMore) {
  CaptureReader reader(file_, default_rig());
  {
    ReadAhead ahead(reader);
    EXPECT_FALSE(ahead.next().items.empty());
  }
  EXPECT_TRUE(read_batch(reader).items.empty()) << "it was interrupted";
}

}  // namespace
}  // namespace crisp
