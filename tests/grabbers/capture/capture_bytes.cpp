// SPDX-License-Identifier: BSD-3-Clause
#include "tests/grabbers/capture/capture_bytes.hpp"

namespace crisp {
namespace {

using namespace crisp::capture;
using namespace crisp::wire;

void put(Bytes& out, std::uint64_t value, std::size_t width, ByteOrder order) {
  for (std::size_t i = 0; i < width; ++i) {
    const auto shift = 8 * (order == ByteOrder::Big ? width - 1 - i : i);
    out.push_back(static_cast<std::uint8_t>(value >> shift));
  }
}

void append(Bytes& out, ByteView bytes) { out.insert(out.end(), bytes.begin(), bytes.end()); }

void pad(Bytes& out) {
  while (out.size() % 4 != 0) out.push_back(0);
}

std::uint32_t original(const Frame& frame) {
  return frame.original_size != 0 ? frame.original_size : static_cast<std::uint32_t>(frame.bytes.size());
}

}  // namespace

FrameSink into(std::vector<Frame>& frames) {
  return [&frames](std::int64_t t, ByteView b) { frames.push_back({t, Bytes(b.begin(), b.end())}); };
}

Bytes pcap_file(const std::vector<Frame>& frames, const PcapLayout& layout) {
  Bytes out;
  const auto u32 = [&](std::uint64_t value) { put(out, value, 4, layout.order); };
  u32(layout.nanoseconds ? 0xa1b23c4d : 0xa1b2c3d4);
  put(out, 2, 2, layout.order);
  put(out, 4, 2, layout.order);
  u32(0);
  u32(0);
  u32(262144);
  u32(layout.link_type);
  for (const auto& frame : frames) {
    const auto fraction = frame.time_ns % 1'000'000'000;
    u32(static_cast<std::uint64_t>(frame.time_ns / 1'000'000'000));
    u32(static_cast<std::uint64_t>(layout.nanoseconds ? fraction : fraction / 1000));
    u32(frame.bytes.size());
    u32(original(frame));
    append(out, frame.bytes);
  }
  return out;
}

PcapngBuilder& PcapngBuilder::block(std::uint32_t type, ByteView body) {
  const auto size = 12 + (body.size() + 3) / 4 * 4;
  put(bytes_, type, 4, order_);
  put(bytes_, size, 4, order_);
  append(bytes_, body);
  pad(bytes_);
  put(bytes_, size, 4, order_);
  return *this;
}

PcapngBuilder& PcapngBuilder::section() {
  Bytes body;
  put(body, 0x1A2B3C4D, 4, order_);
  put(body, 1, 2, order_);
  put(body, 0, 2, order_);
  put(body, ~std::uint64_t{0}, 8, order_);
  return block(0x0A0D0D0A, body);
}

PcapngBuilder& PcapngBuilder::interface(std::uint16_t link_type, std::uint8_t resolution,
                                        std::int64_t offset_s) {
  Bytes body;
  put(body, link_type, 2, order_);
  put(body, 0, 2, order_);
  put(body, 262144, 4, order_);
  put(body, 2, 2, order_);  // if_name, of odd length
  put(body, 5, 2, order_);
  append(body, as_bytes("can0!"));
  pad(body);
  put(body, 9, 2, order_);
  put(body, 1, 2, order_);
  body.push_back(resolution);
  pad(body);
  if (offset_s != 0) {
    put(body, 14, 2, order_);
    put(body, 8, 2, order_);
    put(body, static_cast<std::uint64_t>(offset_s), 8, order_);
  }
  put(body, 0, 4, order_);
  return block(1, body);
}

PcapngBuilder& PcapngBuilder::packet(const Frame& frame, std::uint64_t ticks) {
  Bytes body;
  put(body, frame.interface, 4, order_);
  put(body, ticks >> 32, 4, order_);
  put(body, ticks & 0xFFFFFFFF, 4, order_);
  put(body, frame.bytes.size(), 4, order_);
  put(body, original(frame), 4, order_);
  append(body, frame.bytes);
  pad(body);
  put(body, 1, 2, order_);  // a comment behind the data
  put(body, 3, 2, order_);
  append(body, as_bytes("why"));
  pad(body);
  return block(6, body);
}

PcapngBuilder& PcapngBuilder::obsolete_packet(const Frame& frame, std::uint64_t ticks) {
  Bytes body;
  put(body, frame.interface, 2, order_);
  put(body, 0, 2, order_);
  put(body, ticks >> 32, 4, order_);
  put(body, ticks & 0xFFFFFFFF, 4, order_);
  put(body, frame.bytes.size(), 4, order_);
  put(body, original(frame), 4, order_);
  append(body, frame.bytes);
  return block(2, body);
}

PcapngBuilder& PcapngBuilder::simple_packet(ByteView bytes) {
  Bytes body;
  put(body, bytes.size(), 4, order_);
  append(body, bytes);
  return block(3, body);
}

PcapngBuilder& PcapngBuilder::statistics(std::uint32_t interface, std::uint64_t dropped) {
  Bytes body;
  put(body, interface, 4, order_);
  put(body, 0, 8, order_);
  put(body, 5, 2, order_);
  put(body, 8, 2, order_);
  put(body, dropped, 8, order_);
  put(body, 0, 4, order_);
  return block(5, body);
}

Bytes with_vlan(ByteView ethernet, std::uint16_t tag_type) {
  Bytes out(ethernet.begin(), ethernet.begin() + 12);
  put(out, tag_type, 2, ByteOrder::Big);
  put(out, 0x2005, 2, ByteOrder::Big);
  append(out, ethernet.subspan(12));
  return out;
}

Bytes as_cooked(ByteView ethernet) {
  Bytes out;
  put(out, 1, 4, ByteOrder::Big);
  put(out, 6, 2, ByteOrder::Big);
  append(out, ethernet.subspan(6, 6));
  put(out, 0, 2, ByteOrder::Big);
  append(out, ethernet.subspan(12));
  return out;
}

Bytes as_cooked2(ByteView ethernet) {
  Bytes out(ethernet.begin() + 12, ethernet.begin() + 14);
  put(out, 0, 2, ByteOrder::Big);
  put(out, 3, 4, ByteOrder::Big);
  put(out, 0x0001'00'06, 4, ByteOrder::Big);
  append(out, ethernet.subspan(6, 6));
  put(out, 0, 2, ByteOrder::Big);
  append(out, ethernet.subspan(14));
  return out;
}

Bytes as_raw_ip(ByteView ethernet) { return Bytes(ethernet.begin() + 14, ethernet.end()); }

Bytes as_loopback(ByteView ethernet, std::uint32_t family, ByteOrder order) {
  Bytes out;
  put(out, family, 4, order);
  append(out, ethernet.subspan(14));
  return out;
}

ScanData numbered_scan(std::uint16_t k, std::size_t beams) {
  ScanData data;
  data.serial_number = 4711;
  data.telegram_counter = static_cast<std::uint16_t>(k + 100);
  data.scan_counter = static_cast<std::uint16_t>(k + 50);
  data.scan_time_us = 1'000'000U + 20'000U * k;
  data.transmission_time_us = data.scan_time_us + 17'000;
  data.channels16.push_back({.name = "DIST1", .start_angle = -450000});
  data.channels16[0].angle_step = beams > 541 ? 2500 : 5000;
  for (std::size_t i = 0; i < beams; ++i) {
    data.channels16[0].raw.push_back(static_cast<std::uint16_t>(1000 + (k * 31 + i * 7) % 9000));
  }
  return data;
}

PlateReading numbered_reading(std::uint16_t k) {
  return {.sequence = k, .device_us = 500'000U + 2000U * k, .count = 16U * k};
}

}  // namespace crisp
