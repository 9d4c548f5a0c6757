// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/pcd/parts.hpp"

#include <gmock/gmock.h>

#include <crisp/error.hpp>
#include <crisp/measurement_tables.hpp>

#include "pipeline/files/list_files.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::files;
using namespace crisp::pcd;
namespace fs = std::filesystem;
using testing::ElementsAre;

PcdTable one_value(float value) {
  PcdTable table(1);
  table.add<float>("x", [=](std::size_t) { return value; });
  return table;
}

class Parts : public testing::Test {
 protected:
  void write(int n, float more = 0, PcdFormat format = PcdFormat::binary) const {
    PartsWriter writer(folder_ / "x.pcd", format);
    for (int i = 1; i <= n; ++i) writer.write(one_value(static_cast<float>(i) + more), i < n);
    writer.commit();
  }
  std::vector<float> read(std::string_view name) const {
    std::vector<float> values;
    read_parts(folder_ / name, [&](const PcdTable& table, const fs::path&) {
      values.push_back(table.column<float>("x").front());
    });
    return values;
  }
  const test::TemporaryFolder folder_;
};

TEST_F(Parts, OneIsAFileOfTheNameRequested) {
  write(1);
  EXPECT_TRUE(fs::exists(folder_ / "x.pcd"));
  EXPECT_THAT(read("x.pcd"), ElementsAre(1));
}

TEST_F(Parts, SeveralAreNumberedAndReadInOrder) {
  write(3);
  EXPECT_FALSE(fs::exists(folder_ / "x.pcd"));
  EXPECT_THAT(read("x.pcd"), ElementsAre(1, 2, 3));
  EXPECT_THAT(read("x_0002.pcd"), ElementsAre(2, 3));
}

TEST_F(Parts, PartsOfAnEarlierLongerRecordingAreNotTakenForThisOnes) {
  write(3);
  write(2);
  EXPECT_THAT(read("x.pcd"), ElementsAre(1, 2));
}

TEST_F(Parts, OfTwoRunsAreNotTakenForOneRecording) {
  for (const PcdFormat format : {PcdFormat::ascii, PcdFormat::binary, PcdFormat::binary_compressed}) {
    write(3, 0.1F, format);
    const std::string third = test::bytes_of(folder_ / "x_0003.pcd");
    write(3, 10.1F, format);
    EXPECT_THAT(read("x.pcd"), ElementsAre(11.1F, 12.1F, 13.1F));
    test::put_bytes(folder_ / "x_0003.pcd", third);
    try {
      read("x.pcd");
      ADD_FAILURE() << "parts of two runs were read";
    } catch (const Error& error) {
      EXPECT_EQ(
          error.message().find((folder_ / "x_0003.pcd").string() + " does not continue the part before it"),
          0U)
          << error.what();
    }
  }
}

TEST_F(Parts, OfAnEarlierRunAreRemovedWhenThisOnesAreComplete) {
  const auto names = [&] {
    std::vector<std::string> all;
    for (const auto& file : list_files(folder_ / "")) all.push_back(file.filename().string());
    return all;
  };
  const auto write = [&](int parts) {
    PartsWriter writer(folder_ / "c.pcd", PcdFormat::binary);
    for (int i = 1; i <= parts; ++i) {
      const auto file = writer.write(to_pcd_table(test::sample_cloud(3)), i < parts);
      writer.write_next_to(plate_path(file), to_pcd_table(test::sample_cloud(1)));
    }
    writer.commit();
    return writer.remove_older();
  };
  EXPECT_THAT(write(4), testing::IsEmpty());
  write_file(folder_ / "c_0009.pcd", "of another program");
  write_file(folder_ / "c_00004.pcd", "not a part's name");
  for (const std::string name : {"c_0003.pcd", "c_0003.plate.pcd"})
    write_file(folder_ / (name + kProvenance), "{}");
  EXPECT_THAT(write(2), testing::ElementsAre(folder_ / "c_0003.pcd", folder_ / "c_0004.pcd"));
  EXPECT_THAT(names(), testing::ElementsAre("c_00004.pcd", "c_0001.pcd", "c_0001.plate.pcd", "c_0002.pcd",
                                            "c_0002.plate.pcd", "c_0009.pcd"));
  EXPECT_THAT(write(1), testing::SizeIs(2));
  EXPECT_THAT(names(), testing::ElementsAre("c.pcd", "c.plate.pcd", "c_00004.pcd", "c_0009.pcd"));
  EXPECT_THAT(write(2), testing::ElementsAre(folder_ / "c.pcd"));
  EXPECT_THAT(names(), testing::ElementsAre("c_00004.pcd", "c_0001.pcd", "c_0001.plate.pcd", "c_0002.pcd",
                                            "c_0002.plate.pcd", "c_0009.pcd"));
}

TEST_F(Parts, AFileOfAnotherProgramIsNoneOfAnEarlierRun) {
  write_file(folder_ / "x.pcd", "of another program");
  write_file(folder_ / "x_0003.plate.pcd", "of another program");
  write(3);
  PartsWriter writer(folder_ / "x.pcd", PcdFormat::binary);
  writer.write(one_value(1), true);
  writer.write(one_value(2), false);
  writer.commit();
  EXPECT_THAT(writer.remove_older(), ElementsAre(folder_ / "x_0003.pcd"));
  EXPECT_TRUE(fs::exists(folder_ / "x.pcd"));
  EXPECT_TRUE(fs::exists(folder_ / "x_0003.plate.pcd"));
}

TEST_F(Parts, AMissingOrRenamedPartIsAnError) {
  write(3);
  fs::rename(folder_ / "x_0003.pcd", folder_ / "y_0003.pcd");
  EXPECT_THROW(read("x.pcd"), Error);
  fs::rename(folder_ / "x_0001.pcd", folder_ / "x_0007.pcd");
  EXPECT_THROW(read("x_0007.pcd"), Error);
}

TEST_F(Parts, AFileAndPartsOfTheSameNameAreAmbiguous) {
  write(1);
  write(2);
  EXPECT_THROW(read("x.pcd"), Error);
  EXPECT_THAT(read("x_0001.pcd"), ElementsAre(1, 2));
}

TEST_F(Parts, NothingRemainsOfPartsThatWereNotCommitted) {
  {
    PartsWriter writer(folder_ / "x.pcd", PcdFormat::binary);
    writer.write(one_value(1), true);
    writer.write(one_value(2), false);
  }
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

TEST_F(Parts, AFileThatIsNotThereIsNamed) {
  try {
    read("none.pcd");
    FAIL() << "read what is not there";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("none.pcd: No such file"));
  }
}

}  // namespace
}  // namespace crisp
