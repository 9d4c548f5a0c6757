// SPDX-License-Identifier: BSD-3-Clause
// The example is run as a user runs it, against the emulator.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <sstream>
#include <thread>

#include <crisp/atomic_file.hpp>
#include <crisp/calibration_file.hpp>

#include "grabbers/emulate/emulator.hpp"
#include "grabbers/simulate/recording.hpp"
#include "grabbers/simulate/scenes.hpp"
#include "tests/grabbers/live/live_support.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::emulate;
using namespace crisp::simulate;
using namespace crisp::wire;

void write_rig(const std::filesystem::path& file, const Rig& rig) {
  std::ostringstream text;
  text << "crisp: 1\nlasers:\n";
  for (const RigLaser& laser : rig.lasers) {
    text << "  " << laser.name << ": {address: 127.0.0.1, port: " << laser.address.port
         << ", mount: 45deg, nominal: {lambda: " << laser.nominal.lambda.value << ", tau: 20cm}}\n";
  }
  text << "plate: {address: 127.0.0.1, port: " << rig.plate.address.port << "}\n";
  write_file(file, text.str());
}

struct Ended {
  std::string printed;
  int status = -1;
};

Ended run(const std::string& command) {
  std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  Ended ended;
  std::array<char, 256> line{};
  while (std::fgets(line.data(), line.size(), pipe) != nullptr) ended.printed += line.data();
  ended.status = pclose(pipe);
  return ended;
}

TEST(LiveViewer, PrintsThePointsOfEachRevolution) {
  const test::TemporaryFolder folder;
  RecordingSettings settings;
  settings.scanner.duration = 300;  // it ends with the viewer, whatever a busy machine loses before
  settings.scanner.motion.kind = MotionKind::constant;
  RecordingSimulator simulator(settings, office());
  Rig rig = default_rig();
  for (RigLaser& laser : rig.lasers) laser.address = {"127.0.0.1", 0};
  rig.plate.address = {"127.0.0.1", test::free_datagram_port()};
  Emulator emulator(rig, {.plate_to = rig.plate.address});
  write_rig(folder / "rig.yaml", emulator.rig());
  write_calibration(folder / "truth.yaml", simulator.truth().calibration);

  std::atomic<bool> over = false;
  std::thread scanner([&] {
    while (const auto event = simulator.next()) {
      if (over) return;
      const auto* telegram = std::get_if<LaserTelegram>(&*event);
      const HubItem item = telegram != nullptr ? HubItem(std::make_shared<const Scan>(to_scan(*telegram)))
                                               : HubItem(std::get<PlateReading>(*event));
      emulator.send(item, [&] { return over.load(); });
    }
  });
  const Ended ended = run(std::string(LIVE_VIEWER) + " " + (folder / "rig.yaml").string() + " " +
                          (folder / "truth.yaml").string() + " 3");
  over = true;
  scanner.join();
  EXPECT_EQ(ended.status, 0) << ended.printed;
  std::istringstream lines(ended.printed);
  std::string word;
  std::size_t most =
      0;  // a busy machine loses the greater part of a revolution, which shows in a smaller cloud
  for (int k = 1; k <= 3; ++k) {
    int number = 0;
    std::size_t points = 0;
    lines >> word >> number >> word >> points >> word;
    EXPECT_EQ(number, k) << ended.printed;
    EXPECT_GT(points, 0U) << ended.printed;
    most = std::max(most, points);
  }
  EXPECT_GT(most, 541U) << "more than one scan: " << ended.printed;
}

TEST(LiveViewer, ReportsErrors) {
  const Ended ended = run(std::string(LIVE_VIEWER) + " none.yaml none.yaml 1");
  EXPECT_NE(ended.status, 0);
  EXPECT_NE(ended.printed.find("none.yaml"), std::string::npos) << ended.printed;
}

}  // namespace
}  // namespace crisp
