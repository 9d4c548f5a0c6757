// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/devices/network.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <bit>
#include <cstring>

namespace crisp::devices {
namespace {

constexpr std::array<std::uint8_t, 12> kMapped{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF};

bool is_mapped(const IpAddress& ip) { return std::equal(kMapped.begin(), kMapped.end(), ip.begin()); }

}  // namespace

std::optional<IpAddress> parse_ip(const std::string& text) {
  IpAddress ip{};
  if (inet_pton(AF_INET6, text.c_str(), ip.data()) == 1) return ip;
  std::copy(kMapped.begin(), kMapped.end(), ip.begin());
  if (inet_pton(AF_INET, text.c_str(), ip.data() + kMapped.size()) == 1) return ip;
  return {};
}

std::string to_string(const IpAddress& ip) {
  char text[INET6_ADDRSTRLEN] = "";
  if (is_mapped(ip)) {
    inet_ntop(AF_INET, ip.data() + kMapped.size(), text, sizeof text);
  } else {
    inet_ntop(AF_INET6, ip.data(), text, sizeof text);
  }
  return text;
}

Address to_address(const Endpoint& endpoint) { return {to_string(endpoint.ip), endpoint.port}; }

std::uint32_t internet_sum(wire::ByteView bytes, std::uint32_t sum) {
  // Words are added in this machine's order, which only swaps the bytes of the sum (RFC 1071, section 2B).
  std::uint64_t wide = 0;
  std::size_t i = 0;
  for (; i + 4 <= bytes.size(); i += 4) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + i, 4);
    wide += word;
  }
  std::array<std::uint8_t, 4> rest{};
  std::copy(bytes.begin() + static_cast<std::ptrdiff_t>(i), bytes.end(), rest.begin());
  wide += std::bit_cast<std::uint32_t>(rest);
  while (wide > 0xFFFF) wide = (wide & 0xFFFF) + (wide >> 16);
  auto folded = static_cast<std::uint32_t>(wide);
  if constexpr (std::endian::native == std::endian::little) folded = (folded & 0xFF) << 8 | folded >> 8;
  folded += sum;
  while (folded > 0xFFFF) folded = (folded & 0xFFFF) + (folded >> 16);
  return folded;
}

}  // namespace crisp::devices

std::size_t std::hash<crisp::devices::FlowKey>::operator()(
    const crisp::devices::FlowKey& key) const noexcept {
  // Addresses of one network differ in few bits; each step spreads those of a word over all that follow.
  std::uint64_t mixed = 0;
  const auto mix = [&](std::uint64_t value) {
    mixed = (mixed ^ value) * 0x9e3779b97f4a7c15;
    mixed ^= mixed >> 32;
  };
  for (const auto* end : {&key.from, &key.to}) {
    std::array<std::uint64_t, 2> words{};
    static_assert(sizeof words == sizeof end->ip);
    std::memcpy(words.data(), end->ip.data(), sizeof words);
    for (const auto word : words) mix(word);
    mix(end->port);
  }
  mix(static_cast<std::uint64_t>(key.transport));
  return mixed;
}
