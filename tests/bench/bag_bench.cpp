// SPDX-License-Identifier: BSD-3-Clause
// How fast bags are read, on one core, from the page cache: scans of 1081 beams and joint states, as a stage
// takes them.
#include <benchmark/benchmark.h>

#include <filesystem>

#include "grabbers/bag/bag_file.hpp"
#include "grabbers/bag/bag_items.hpp"
#include "grabbers/bag/bag_routes.hpp"
#include "tests/grabbers/bag/bag_writer.hpp"

namespace crisp {
namespace {

using namespace crisp::bag;

test::TestBag long_bag(bool ros2) {
  constexpr int kScans = 20'000;
  constexpr std::int64_t kPeriod = 25'000'000;
  const std::string msg = ros2 ? "/msg/" : "/";
  test::TestBag bag{
      .topics = {
          {"/scan", "sensor_msgs" + msg + "LaserScan", ros2 ? "" : test::kLaserScanDefinition},
          {"/joint_states", "sensor_msgs" + msg + "JointState", ros2 ? "" : test::kJointStateDefinition}}};
  std::vector<float> ranges(1081);
  for (int i = 0; i < kScans; ++i) {
    const std::int64_t stamp = 1'700'000'000'000'000'000 + kPeriod * i;
    for (std::size_t k = 0; k < ranges.size(); ++k)
      ranges[k] = 0.001F * static_cast<float>(1000 + (37 * k + 11 * static_cast<std::size_t>(i)) % 8000);
    bag.messages.push_back({0, stamp + kPeriod,
                            test::scan_bytes({.stamp_ns = stamp,
                                              .angle_min = -2.35619F,
                                              .angle_increment = 0.00436332F,
                                              .time_increment = 1e-5F,
                                              .ranges = ranges},
                                             ros2)});
    bag.messages.push_back({1, stamp, test::joints_bytes(stamp, {"tilt"}, {1e-4 * i}, ros2)});
  }
  return bag;
}

void read_bag(benchmark::State& state, const char* ending, const char* compression) {
  const auto file = std::filesystem::temp_directory_path() / (std::string("crisp_bench") + ending);
  std::filesystem::remove(file);
  const std::string kind = ending;
  if (kind == ".bag") test::write_rosbag1(file, long_bag(false), compression);
  if (kind == ".mcap") test::write_mcap(file, long_bag(true), compression);
  if (kind == ".db3") test::write_db3(file, long_bag(true));
  Rig rig = default_rig();
  rig.lasers.resize(1);
  std::int64_t bytes = 0;
  for (auto unused : state) {
    BagFile bag(file);
    BagRoutes routes(rig);
    BagItems items(rig, 1);
    std::vector<BagRoute> routed;
    while (const auto message = bag.reader().next()) {
      const auto& connections = bag.reader().connections();
      while (routed.size() < connections.size()) routed.push_back(routes.route(connections[routed.size()]));
      const BagRoute& route = routed[message->connection];
      if (route.scans) items.add(route.scans->decode(message->data), message->receipt_ns, 0);
      if (route.angles) items.add(*route.angles->decode(message->data), message->receipt_ns);
      bytes += static_cast<std::int64_t>(message->data.size());
    }
    items.for_each_measured([](const std::shared_ptr<const Measurements>& beams) {
      benchmark::DoNotOptimize(beams->range.data());
    });
  }
  state.SetBytesProcessed(bytes);
  std::filesystem::remove(file);
}
BENCHMARK_CAPTURE(read_bag, rosbag1_plain, ".bag", "none")->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read_bag, rosbag1_lz4, ".bag", "lz4")->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read_bag, mcap_plain, ".mcap", "")->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read_bag, mcap_lz4, ".mcap", "lz4")->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read_bag, mcap_zstd, ".mcap", "zstd")->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read_bag, sqlite, ".db3", "")->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace crisp
