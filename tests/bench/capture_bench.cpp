// SPDX-License-Identifier: BSD-3-Clause
// How fast captures are read: bytes of the file and items a second, on one core, from the page cache.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <filesystem>
#include <map>

#include <crisp/capture_reader.hpp>

#include "grabbers/capture/capture_file.hpp"
#include "grabbers/capture/frame_builder.hpp"
#include "grabbers/capture/pcap_writer.hpp"
#include "grabbers/wire/cola_framer.hpp"
#include "grabbers/wire/plate_sentence.hpp"
#include "grabbers/wire/scan_conversion.hpp"

namespace crisp {
namespace {

using namespace crisp::capture;
using namespace crisp::wire;

constexpr std::int64_t kMillisecond = 1'000'000;

/// What three lasers and the plate of the default rig send in `seconds`.
struct Traffic {
  std::size_t beams = 541;
  bool remissions = false;
  ColaLanguage language = ColaLanguage::B;
  int seconds = 600;
};

ScanData scan(const Traffic& traffic, int k) {
  ScanData data;
  data.telegram_counter = data.scan_counter = static_cast<std::uint16_t>(k);
  data.scan_time_us = static_cast<std::uint32_t>(20'000 * k);
  data.transmission_time_us = data.scan_time_us + 17'000;
  ChannelBlock channel{.name = "DIST1", .start_angle = -450000};
  channel.angle_step = traffic.beams > 541 ? 2500 : 5000;
  for (std::size_t i = 0; i < traffic.beams; ++i)
    channel.raw.push_back(static_cast<std::uint16_t>(1000 + (i * 37 + k) % 8000));
  data.channels16.push_back(channel);
  channel.name = "RSSI1";
  if (traffic.remissions) data.channels16.push_back(channel);
  return data;
}

class TemporaryCapture {
 public:
  explicit TemporaryCapture(const Traffic& traffic)
      : path_(std::filesystem::temp_directory_path() / "crisp-capture-bench.pcap") {
    PcapWriter file(path_, PcapMode::Replace);
    FrameSorter sorter([&](std::int64_t t, ByteView b) { file.write(t, b); }, 100 * kMillisecond);
    const FrameSink sink = [&](std::int64_t t, ByteView b) { sorter.push(t, b); };
    const Address hub{"192.168.0.100", 50000}, hub_plate{"192.168.0.100", 4000};
    std::vector<TcpConversation> lasers;
    for (const auto& laser : default_rig().lasers)
      lasers.emplace_back(Address{laser.address.ip, 2112}, hub, sink);
    DatagramSender plate({"192.168.0.10", 4000}, hub_plate, sink);
    for (int k = 0; k < 50 * traffic.seconds; ++k) {
      const auto telegram = encode_scan_data(scan(traffic, k), traffic.language);
      const auto start = 1'700'000'000'000 * kMillisecond + k * 20 * kMillisecond;
      for (auto& laser : lasers) laser.send(TcpSide::Server, telegram, start + 3 * kMillisecond);
      for (int j = 0; j < 10; ++j) {
        const PlateReading reading{.sequence = static_cast<std::uint16_t>(10 * k + j),
                                   .device_us = static_cast<std::uint32_t>(20'000 * k + 2000 * j)};
        plate.send(as_bytes(encode_plate_sentence(reading)), start + 2 * j * kMillisecond);
      }
    }
    sorter.finish();
    file.close();
  }
  ~TemporaryCapture() { std::filesystem::remove(path_); }
  TemporaryCapture(const TemporaryCapture&) = delete;
  TemporaryCapture& operator=(const TemporaryCapture&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

void set_rates(benchmark::State& state, std::uint64_t bytes, std::uint64_t items, double seconds) {
  state.SetBytesProcessed(static_cast<std::int64_t>(bytes));
  state.counters["items/s"] = benchmark::Counter(static_cast<double>(items), benchmark::Counter::kIsRate);
  if (seconds > 0) state.counters["x real time"] = benchmark::Counter(seconds, benchmark::Counter::kIsRate);
}

void read_capture(benchmark::State& state, const Traffic& traffic) {
  const TemporaryCapture capture(traffic);
  std::uint64_t items = 0, bytes = 0;
  for (auto _ : state) {
    CaptureReader reader(capture.path(), default_rig());
    while (const auto item = reader.next()) ++items;
    bytes += reader.statistics().file_bytes;
  }
  set_rates(state, bytes, items, static_cast<double>(state.iterations()) * traffic.seconds);
}

void read_packets_only(benchmark::State& state) {
  const TemporaryCapture capture(Traffic{});
  std::uint64_t packets = 0, bytes = 0;
  for (auto _ : state) {
    CaptureFile file(capture.path());
    while (file.next() != nullptr) ++packets;
    bytes += file.offset();
  }
  set_rates(state, bytes, packets, 0);
}

void decode_telegram(benchmark::State& state, ColaLanguage language) {
  const auto frame = encode_scan_data(scan(Traffic{}, 1), language);
  ColaFramer framer;
  ScanData data;
  Scan decoded;
  std::uint64_t telegrams = 0;
  for (auto _ : state) {
    framer.feed(frame, 0, [&](const ColaFrame& found) {
      decode_scan_data(*parse_cola(found.payload, found.language), EncoderWidths::Position32, data);
      to_scan(data, 0, 0, decoded);
      ++telegrams;
    });
    benchmark::DoNotOptimize(decoded.echoes.front().ranges.data());
  }
  set_rates(state, frame.size() * telegrams, telegrams, 0);
}

void encode_telegram(benchmark::State& state, ColaLanguage language) {
  const auto data = scan(Traffic{}, 1);
  Bytes out;
  std::uint64_t bytes = 0;
  for (auto _ : state) {
    out.clear();
    append_scan_data(data, language, "sSN", EncoderWidths::Position32, out);
    bytes += out.size();
  }
  set_rates(state, bytes, static_cast<std::uint64_t>(state.iterations()), 0);
}

BENCHMARK_CAPTURE(read_capture, 541_beams, Traffic{})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read_capture, 1081_beams_with_remissions,
                  Traffic{.beams = 1081, .remissions = true, .seconds = 200})
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read_capture, 541_beams_cola_a, Traffic{.language = ColaLanguage::A})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(read_packets_only)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(decode_telegram, cola_a, ColaLanguage::A);
BENCHMARK_CAPTURE(decode_telegram, cola_b, ColaLanguage::B);
BENCHMARK_CAPTURE(encode_telegram, cola_a, ColaLanguage::A);
BENCHMARK_CAPTURE(encode_telegram, cola_b, ColaLanguage::B);

}  // namespace
}  // namespace crisp
