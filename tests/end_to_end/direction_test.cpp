// SPDX-License-Identifier: BSD-3-Clause
// The encoder's direction: a capture of negated counts makes the mirror image of the scene, as crisp as the
// scene.
#include <gmock/gmock.h>

#include "tests/end_to_end/pipeline_fixture.hpp"
#include "tests/end_to_end/room.hpp"
#include "tests/support/source_dir.hpp"

namespace crisp {
namespace {

using namespace crisp::app;
using testing::HasSubstr;
using testing::Not;

class Direction : public testing::Test {
 protected:
  void SetUp() override { fixture_.simulate("made", {"duration=5s", "lasers.step=1deg"}, rig("clockwise")); }
  std::filesystem::path rig(const std::string& direction) const {
    std::string yaml = test::bytes_of(source_dir() + "/configs/rig.yaml");
    const std::string key = "direction: counter_clockwise";
    yaml.replace(yaml.find(key), key.size(), "direction: " + direction);
    auto file = fixture_ / ("rig_" + direction + ".yaml");
    test::put_bytes(file, yaml);
    return file;
  }
  test::Outcome calibrate(const std::string& direction) const {
    return fixture_.run("calibrate.yaml", fixture_ / "made/hub.pcap", "out_" + direction, {}, rig(direction));
  }

  test::PipelineFixture fixture_;
};

TEST_F(Direction, OfTheWrongWayIsNamedAndNotTrustedAndAutoCorrectsIt) {
  const auto right = calibrate("clockwise");
  EXPECT_EQ(right.status, ExitStatus::done) << right.console;
  EXPECT_THAT(right.console, Not(HasSubstr("encoder")));

  const auto wrong = calibrate("counter_clockwise");
  EXPECT_EQ(wrong.status, ExitStatus::not_trusted);
  EXPECT_THAT(wrong.console, HasSubstr("the encoder counts clockwise, not counter-clockwise"));
  EXPECT_THAT(wrong.console, HasSubstr("Set plate.direction: clockwise in the rig"));

  const auto found = calibrate("auto");
  EXPECT_EQ(found.status, ExitStatus::done) << found.console;
  EXPECT_THAT(found.console, HasSubstr("the encoder counts clockwise"));
  ASSERT_EQ(found.cloud->size(), right.cloud->size());
  double sum = 0;
  for (std::size_t i = 0; i < found.cloud->size(); ++i) {
    sum += ((*found.cloud)[i].getVector3fMap() - (*right.cloud)[i].getVector3fMap()).squaredNorm();
  }
  EXPECT_LT(std::sqrt(sum / static_cast<double>(found.cloud->size())), 0.002);
}

}  // namespace
}  // namespace crisp
