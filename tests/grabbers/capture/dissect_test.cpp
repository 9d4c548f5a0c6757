// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/dissect.hpp"

#include <gmock/gmock.h>

#include "tests/grabbers/capture/capture_bytes.hpp"

namespace crisp {
namespace {

using namespace crisp::capture;
using namespace crisp::devices;
using namespace crisp::wire;

Packet packet(ByteView bytes, std::uint32_t link_type) {
  return {.link_type = link_type, .original_size = static_cast<std::uint32_t>(bytes.size()), .bytes = bytes};
}

Bytes tcp_frame(bool ipv6, std::size_t payload = 50) {
  std::vector<Frame> frames;
  TcpConversation conversation(ipv6 ? Address{"fe80::1", 2112} : kLaser1,
                               ipv6 ? Address{"fe80::64", 50000} : kHub, into(frames));
  conversation.send(TcpSide::Server, Bytes(payload, 'a'), 0);
  return frames[0].bytes;
}

Bytes udp_frame() {
  std::vector<Frame> frames;
  DatagramSender(kPlate, kHubPlate, into(frames)).send(Bytes(33, 'p'), 0);
  return frames[0].bytes;
}

std::optional<TransportPacket> dissect(const Packet& packet) {
  const auto ip = dissect_ip(packet);
  if (!std::holds_alternative<IpPacket>(ip)) return {};
  bool damaged = false;
  const auto found = dissect_transport(std::get<IpPacket>(ip), damaged);
  EXPECT_EQ(damaged, !found.has_value());
  return found;
}

void expect_laser(const std::optional<TransportPacket>& found, bool ipv6) {
  ASSERT_TRUE(found);
  EXPECT_EQ(to_string(found->key.from.ip), ipv6 ? "fe80::1" : "192.168.0.1");
  EXPECT_EQ(found->key.from.port, 2112);
  EXPECT_EQ(found->key.to.port, 50000);
  EXPECT_EQ(found->key.transport, Transport::Tcp);
  EXPECT_EQ(found->sequence, 1'000'000U);
  EXPECT_THAT(found->payload, testing::SizeIs(50));
  EXPECT_EQ(found->checksum, ChecksumVerdict::Right);
  EXPECT_EQ(found->missing, 0U);
}

TEST(Dissect, FindsTheSameSegmentInEveryLinkLayer) {
  for (const bool ipv6 : {false, true}) {
    const auto ethernet = tcp_frame(ipv6);
    expect_laser(dissect(packet(ethernet, 1)), ipv6);
    expect_laser(dissect(packet(with_vlan(ethernet, 0x8100), 1)), ipv6);
    expect_laser(dissect(packet(with_vlan(with_vlan(ethernet, 0x8100), 0x88A8), 1)), ipv6);
    expect_laser(dissect(packet(as_cooked(ethernet), 113)), ipv6);
    expect_laser(dissect(packet(as_cooked2(ethernet), 276)), ipv6);
    for (const std::uint32_t raw : {101, 12, 14, 228, 229})
      expect_laser(dissect(packet(as_raw_ip(ethernet), raw)), ipv6);
    const std::uint32_t family = ipv6 ? 30 : 2;
    expect_laser(dissect(packet(as_loopback(ethernet, family, ByteOrder::Little), 0)), ipv6);
    expect_laser(dissect(packet(as_loopback(ethernet, family, ByteOrder::Big), 0)), ipv6);
    expect_laser(dissect(packet(as_loopback(ethernet, family, ByteOrder::Big), 108)), ipv6);
  }
}

TEST(Dissect, FindsDatagrams) {
  const auto frame = udp_frame();
  const auto found = dissect(packet(frame, 1));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->key.transport, Transport::Udp);
  EXPECT_EQ(found->key.from.port, 4000);
  EXPECT_EQ(as_text(found->payload), std::string(33, 'p'));
  EXPECT_EQ(found->checksum, ChecksumVerdict::Right);
}

TEST(Dissect, LeavesThePaddingOfShortFramesOut) {
  auto bytes = tcp_frame(false, 1);
  bytes.resize(64, 0xEE);  // Ethernet's least, and a frame check sequence
  const auto found = dissect(packet(bytes, 1));
  ASSERT_TRUE(found);
  EXPECT_EQ(as_text(found->payload), "a");
}

TEST(Dissect, ReportsHowMuchTheCaptureCutOff) {
  const auto whole = tcp_frame(false);
  auto cut = packet(ByteView(whole).first(whole.size() - 20), 1);
  cut.original_size = static_cast<std::uint32_t>(whole.size());
  const auto found = dissect(cut);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->payload.size(), 30U);
  EXPECT_EQ(found->missing, 20U);
  EXPECT_EQ(found->checksum, ChecksumVerdict::Unknown);
}

TEST(Dissect, SeesADamagedByteOfThePayload) {
  for (const bool ipv6 : {false, true}) {
    auto bytes = tcp_frame(ipv6);
    bytes.back() ^= 4;
    const auto found = dissect(packet(bytes, 1));
    ASSERT_TRUE(found);
    EXPECT_EQ(found->checksum, ChecksumVerdict::Wrong);
  }
}

TEST(Dissect, TakesChecksumsThatTheNetworkCardWasToFillInAsUnknown) {
  auto bytes = tcp_frame(false);
  // The sum of the pseudo-header alone, as a kernel leaves it: addresses, protocol 6, length 70.
  const std::uint32_t sum = 0xC0A8 + 0x0001 + 0xC0A8 + 0x0064 + 6 + 70;
  const std::uint32_t folded = (sum & 0xFFFF) + (sum >> 16);
  bytes[14 + 20 + 16] = static_cast<std::uint8_t>(folded >> 8);
  bytes[14 + 20 + 17] = static_cast<std::uint8_t>(folded);
  EXPECT_EQ(dissect(packet(bytes, 1))->checksum, ChecksumVerdict::Unknown);
}

TEST(Dissect, RefusesEveryFlippedBitOfAnIpv4Header) {
  const auto bytes = tcp_frame(false);
  for (std::size_t bit = 14 * 8; bit < 34 * 8; ++bit) {
    auto damaged = bytes;
    damaged[bit / 8] ^= static_cast<std::uint8_t>(1 << (bit % 8));
    const auto found = dissect_ip(packet(damaged, 1));
    ASSERT_TRUE(std::holds_alternative<NoIp>(found)) << bit;
    EXPECT_EQ(std::get<NoIp>(found), NoIp::Damaged);
  }
}

TEST(Dissect, ReportsWhyAPacketHoldsNoIp) {
  EXPECT_EQ(std::get<NoIp>(dissect_ip(packet(Bytes(60, 0), 147))), NoIp::UnknownLinkType);
  auto arp = tcp_frame(false);
  arp[12] = 0x08;
  arp[13] = 0x06;
  EXPECT_EQ(std::get<NoIp>(dissect_ip(packet(arp, 1))), NoIp::OtherProtocol);
  EXPECT_EQ(std::get<NoIp>(dissect_ip(packet(Bytes(5), 1))), NoIp::Damaged);
}

TEST(Dissect, WalksOverIpv6Extensions) {
  const auto ethernet = tcp_frame(true);
  Bytes raw = as_raw_ip(ethernet);
  const Bytes hop_by_hop{43, 0, 1, 4, 0, 0, 0, 0}, routing{60, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  const Bytes destination{6, 0, 1, 4, 0, 0, 0, 0};
  Bytes extensions = hop_by_hop;
  extensions.insert(extensions.end(), routing.begin(), routing.end());
  extensions.insert(extensions.end(), destination.begin(), destination.end());
  raw.insert(raw.begin() + 40, extensions.begin(), extensions.end());
  raw[6] = 0;  // hop by hop
  raw[5] = static_cast<std::uint8_t>(raw[5] + extensions.size());
  expect_laser(dissect(packet(raw, 101)), true);
}

TEST(Dissect, SurvivesPacketsCutAtEveryByte) {
  for (const bool ipv6 : {false, true}) {
    for (const auto& [bytes, type] : {std::pair{tcp_frame(ipv6), 1U},
                                      {as_cooked(tcp_frame(ipv6)), 113U},
                                      {as_cooked2(tcp_frame(ipv6)), 276U},
                                      {with_vlan(tcp_frame(ipv6), 0x8100), 1U},
                                      {as_loopback(tcp_frame(ipv6), 2, ByteOrder::Little), 0U}}) {
      for (std::size_t size = 0; size < bytes.size(); ++size) {
        for (const bool by_the_capture : {false, true}) {
          auto cut = packet(ByteView(bytes).first(size), type);
          if (by_the_capture) cut.original_size = static_cast<std::uint32_t>(bytes.size());
          const auto found = dissect(cut);
          ASSERT_TRUE(!found || found->payload.size() <= 50U);
        }
      }
    }
  }
}

TEST(InternetSum, IsThatOfTheExampleInRfc1071) {
  const Bytes bytes{0x00, 0x01, 0xf2, 0x03, 0xf4, 0xf5, 0xf6, 0xf7};
  EXPECT_EQ(internet_sum(bytes), 0xddf2U);
  EXPECT_EQ(internet_sum(ByteView(bytes).first(7)), 0xddf2U - 0xf7U);
}

TEST(IpAddress, AreReadAndWritten) {
  for (const auto* text : {"192.168.0.1", "fe80::1", "0.0.0.0", "2001:db8::8:800:200c:417a"}) {
    ASSERT_TRUE(parse_ip(text)) << text;
    EXPECT_EQ(to_string(*parse_ip(text)), text);
  }
  for (const auto* text : {"", "192.168.0", "192.168.0.256", "laser1", "fe80:::1"})
    EXPECT_FALSE(parse_ip(text)) << text;
}

}  // namespace
}  // namespace crisp
