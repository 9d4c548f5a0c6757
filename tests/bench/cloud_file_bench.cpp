// SPDX-License-Identifier: BSD-3-Clause
// How fast clouds are written as PLY and LAS: points and bytes a second, on one core, with the disk's part of
// it.
#include <benchmark/benchmark.h>

#include <filesystem>

#include "plugins/write/las_writer.hpp"
#include "plugins/write/ply_writer.hpp"

namespace crisp {
namespace {

using namespace crisp::write;

constexpr std::size_t kPoints = 10'000'000;

Point point_of(std::size_t i) {
  Point point;
  point.x = 1e-3F * static_cast<float>(i % 20'011);
  point.y = 1e-3F * static_cast<float>(i % 9'973);
  point.z = 1e-3F * static_cast<float>(i % 3'001);
  point.intensity = static_cast<float>(i % 1'024);
  point.laser = static_cast<std::uint16_t>(i % 3);
  point.beam = static_cast<std::uint16_t>(i % 541);
  point.time = 1e-6 * static_cast<double>(i);
  return point;
}

template <class Writer>
void write_cloud_file(benchmark::State& state) {
  const auto file = std::filesystem::temp_directory_path() / (std::string("crisp_bench") + Writer::kEnding);
  constexpr std::uint64_t kStamp = 1'700'000'000'000'000;
  for (auto unused : state) {
    Writer writer(file, kStamp, point_of(0));
    for (std::size_t i = 0; i < kPoints; ++i) writer.add(point_of(i), 0);
    writer.commit();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kPoints));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(std::filesystem::file_size(file)));
  std::filesystem::remove(file);
}
BENCHMARK_TEMPLATE(write_cloud_file, LasWriter)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(write_cloud_file, PlyWriter)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace crisp
