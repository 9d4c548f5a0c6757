// SPDX-License-Identifier: BSD-3-Clause
#include "tests/grabbers/wire/samples.hpp"

#include <cctype>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>

#include "tests/support/source_dir.hpp"

namespace crisp {

using namespace crisp::wire;

Bytes from_hex(std::string_view hex) {
  std::string digits;
  for (const char c : hex) {
    if (std::isxdigit(static_cast<unsigned char>(c)) != 0) digits += c;
  }
  Bytes bytes;
  for (std::size_t i = 0; i + 1 < digits.size(); i += 2) {
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(digits.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

Bytes real_telegram(std::string_view file) {
  std::ifstream in(std::filesystem::path(source_dir()) / "tests/grabbers/wire/telegrams" / file);
  return from_hex(std::string(std::istreambuf_iterator<char>(in), {}));
}

ScanData full_scan_data(std::uint32_t seed) {
  std::mt19937 generator(seed);
  const auto random = [&] { return static_cast<std::uint32_t>(generator()); };
  const auto channel = [&](const char* name, std::size_t n, std::uint32_t largest) {
    ChannelBlock block{.name = name, .scale = 2, .offset = -0.5F, .start_angle = -450000, .angle_step = 3333};
    for (std::size_t i = 0; i < n; ++i)
      block.raw.push_back(static_cast<std::uint16_t>(random() % (largest + 1)));
    return block;
  };
  ScanData data;
  data.version = static_cast<std::uint16_t>(random());
  data.serial_number = random();
  data.device_status = 0x0104;
  data.telegram_counter = static_cast<std::uint16_t>(random());
  data.scan_counter = static_cast<std::uint16_t>(random());
  data.scan_time_us = random();
  data.transmission_time_us = random();
  data.digital_inputs = 0x0203;
  data.digital_outputs = 0x8001;
  data.layer = 0xFFF6;
  data.encoders = {{random(), -32768}, {random(), 32767}};
  data.channels16 = {channel("DIST1", 40, 0xFFFF), channel("DIST2", 40, 0xFFFF),
                     channel("RSSI1", 40, 0xFFFF)};
  data.channels8 = {channel("RSSI2", 40, 0xFF), channel("QLTY1", 0, 0xFF)};
  data.position = PositionBlock{{1.5F, -2.5F, 0.0F, 1e-20F, -3e20F, 0.1F}, 7};
  data.name = "not defined";
  data.comment = "";
  data.time = TimeBlock{2026, 2, 28, 23, 59, 60, 999999};
  data.event = EventBlock{"FDIN", random(), random(), -12345};
  return data;
}

std::vector<FoundTelegram> find_telegrams(ByteView stream, std::size_t piece, ColaFramer::Counts* counts) {
  std::vector<FoundTelegram> found;
  ColaFramer framer;
  const auto take = [&](const ColaFrame& frame) {
    found.push_back({frame.language, Bytes(frame.payload.begin(), frame.payload.end()), frame.completed_ns});
  };
  for (std::size_t i = 0; i * piece < stream.size(); ++i) {
    framer.feed(stream.subspan(i * piece, std::min(piece, stream.size() - i * piece)),
                static_cast<std::int64_t>(i), take);
  }
  framer.gap(take);
  if (counts != nullptr) *counts = framer.counts();
  return found;
}

}  // namespace crisp
