// SPDX-License-Identifier: BSD-3-Clause
#include "tests/independent/wire.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace independent {
namespace {

std::string big(std::uint64_t value, int bytes) {
  std::string text;
  for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) text += static_cast<char>(value >> shift & 0xff);
  return text;
}

std::string little(std::uint64_t value, int bytes) {
  std::string text = big(value, bytes);
  std::reverse(text.begin(), text.end());
  return text;
}

std::string ip_bytes(const std::string& dotted) {
  std::istringstream in(dotted);
  std::string bytes, part;
  while (std::getline(in, part, '.')) bytes += static_cast<char>(std::stoi(part));
  return bytes;
}

/// The internet checksum (RFC 1071).
std::uint16_t internet_checksum(const std::string& bytes) {
  std::uint32_t sum = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const auto byte = static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i]));
    sum += i % 2 == 0 ? byte << 8 : byte;
  }
  while (sum >> 16) sum = (sum & 0xffff) + (sum >> 16);
  return static_cast<std::uint16_t>(~sum);
}

std::string ip_packet(const Endpoint& from, const Endpoint& to, int protocol, const std::string& body) {
  const std::string addresses = ip_bytes(from.ip) + ip_bytes(to.ip);
  const std::string head = big(0x4500, 2) + big(20 + body.size(), 2) + big(0, 2) + big(0x4000, 2) +
                           big(64, 1) + big(static_cast<std::uint64_t>(protocol), 1);
  return head + big(internet_checksum(head + addresses), 2) + addresses + body;
}

std::string pseudo_header(const Endpoint& from, const Endpoint& to, int protocol, std::size_t length) {
  return ip_bytes(from.ip) + ip_bytes(to.ip) + big(static_cast<std::uint64_t>(protocol), 2) + big(length, 2);
}

struct LinkHeader {
  std::uint32_t type;  // of the capture file
  std::string bytes;
};

LinkHeader link_header(const std::string& link) {
  const std::string host = "\x02\x1a\x2b\x3c\x4d\x5e", device = "\x02\x5e\x4d\x3c\x2b\x1a";
  if (link == "ethernet") return {1, host + device + big(0x0800, 2)};
  if (link == "vlan") return {1, host + device + big(0x8100, 2) + big(42, 2) + big(0x0800, 2)};
  if (link == "sll") return {113, big(0, 2) + big(1, 2) + big(6, 2) + device + big(0, 2) + big(0x0800, 2)};
  if (link == "sll2")
    return {276,
            big(0x0800, 2) + big(0, 2) + big(2, 4) + big(1, 2) + big(0, 1) + big(6, 1) + device + big(0, 2)};
  if (link == "raw") return {101, ""};
  if (link == "loopback") return {0, little(2, 4)};
  throw std::runtime_error("link " + link + " is unknown");
}

/// A pcapng block, its length before and after.
std::string block(std::uint32_t type, std::string body) {
  body.resize((body.size() + 3) / 4 * 4, '\0');
  const std::string length = little(body.size() + 12, 4);
  return little(type, 4) + length + body + length;
}

}  // namespace

std::string udp_packet(const Endpoint& from, const Endpoint& to, const std::string& payload) {
  const std::size_t length = 8 + payload.size();
  const std::string head = big(static_cast<std::uint64_t>(from.port), 2) +
                           big(static_cast<std::uint64_t>(to.port), 2) + big(length, 2);
  const auto checksum = internet_checksum(pseudo_header(from, to, 17, length) + head + big(0, 2) + payload);
  return ip_packet(from, to, 17, head + big(checksum, 2) + payload);
}

std::string tcp_packet(const Endpoint& from, const Endpoint& to, std::uint32_t sequence,
                       std::uint32_t acknowledged, int flags, const std::string& payload) {
  const std::string head = big(static_cast<std::uint64_t>(from.port), 2) +
                           big(static_cast<std::uint64_t>(to.port), 2) + big(sequence, 4) +
                           big(acknowledged, 4) + big(0x50, 1) + big(static_cast<std::uint64_t>(flags), 1) +
                           big(0xfaf0, 2);
  const auto checksum =
      internet_checksum(pseudo_header(from, to, 6, 20 + payload.size()) + head + big(0, 4) + payload);
  return ip_packet(from, to, 6, head + big(checksum, 2) + big(0, 2) + payload);
}

void write_capture(const std::string& path, std::vector<Packet> packets, const std::string& container,
                   const std::string& link, std::int64_t epoch) {
  std::stable_sort(packets.begin(), packets.end(),
                   [](const Packet& a, const Packet& b) { return a.time < b.time; });
  const LinkHeader header = link_header(link);
  const bool is_ng = container == "pcapng", is_big = container.ends_with("_big");
  const bool has_nanoseconds = is_ng || container.starts_with("pcap_ns");
  const auto put = [&](std::uint64_t value, int bytes) {
    return is_big ? big(value, bytes) : little(value, bytes);
  };
  std::ofstream file(path, std::ios::binary);
  if (is_ng) {
    file << block(0x0A0D0D0A, little(0x1A2B3C4D, 4) + little(1, 2) + little(0, 2) + std::string(8, '\xff'));
    const std::string resolution = little(9, 2) + little(1, 2) + little(9, 4) + little(0, 4);  // nanoseconds
    file << block(1, little(header.type, 2) + little(0, 2) + little(0, 4) + resolution);
  } else {
    file << put(has_nanoseconds ? 0xA1B23C4D : 0xA1B2C3D4, 4) << put(2, 2) << put(4, 2) << put(0, 8);
    file << put(262144, 4) << put(header.type, 4);
  }
  for (const auto& packet : packets) {
    const std::string frame = header.bytes + packet.data;
    const auto time = static_cast<std::uint64_t>(epoch + std::llround(1e9 * packet.time));
    if (is_ng) {
      file << block(6, little(0, 4) + little(time >> 32, 4) + little(time & 0xffffffff, 4) +
                           little(frame.size(), 4) + little(frame.size(), 4) + frame);
      continue;
    }
    file << put(time / 1000000000, 4) << put(time % 1000000000 / (has_nanoseconds ? 1 : 1000), 4);
    file << put(frame.size(), 4) << put(frame.size(), 4) << frame;
  }
  if (!file) throw std::runtime_error("cannot write " + path);
}

}  // namespace independent
