// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/frame_builder.hpp"

#include <gmock/gmock.h>
#include <tins/ethernetII.h>
#include <tins/ip.h>
#include <tins/ipv6.h>
#include <tins/rawpdu.h>
#include <tins/tcp.h>
#include <tins/udp.h>

#include <crisp/error.hpp>

#include "tests/grabbers/capture/capture_bytes.hpp"

namespace crisp {
namespace {

using namespace crisp::capture;
using namespace crisp::wire;
using testing::ElementsAre;

const Address kLaser6{"fe80::1", 2112}, kHub6{"fe80::64", 50000};

Tins::TCP tcp(const Frame& frame) {
  return Tins::EthernetII(frame.bytes.data(), static_cast<std::uint32_t>(frame.bytes.size()))
      .rfind_pdu<Tins::TCP>();
}

/// RFC 1071's sum of 16-bit words, folded: 0xFFFF for data that hold their own right checksum.
std::uint32_t folded(ByteView bytes, std::uint32_t sum) {
  for (std::size_t i = 0; i < bytes.size(); ++i)
    sum += static_cast<std::uint32_t>(bytes[i]) << (i % 2 == 0 ? 8 : 0);
  while (sum > 0xFFFF) sum = (sum & 0xFFFF) + (sum >> 16);
  return sum;
}

void expect_right_checksums(const Frame& frame, bool ipv6, std::uint8_t protocol) {
  const ByteView ip = ByteView(frame.bytes).subspan(14);
  const auto header = ip.first(ipv6 ? 40 : 20);
  EXPECT_TRUE(ipv6 || folded(header, 0) == 0xFFFFU);
  const std::size_t length = ipv6 ? std::size_t{ip[4]} * 256 + ip[5] : std::size_t{ip[2]} * 256 + ip[3] - 20;
  const auto transport = ip.subspan(header.size(), length);
  const auto addresses = ipv6 ? header.subspan(8, 32) : header.subspan(12, 8);
  EXPECT_EQ(folded(transport, folded(addresses, protocol + static_cast<std::uint32_t>(length))), 0xFFFFU);
}

TEST(TcpConversation, ResemblesARealOne) {
  std::vector<Frame> frames;
  TcpConversation conversation(kLaser1, kHub, into(frames),
                               {.server_sequence = 0xFFFFFFF0, .client_sequence = 77});
  conversation.open(1'000'000);
  conversation.send(TcpSide::Client, Bytes(20, 'q'), 2'000'000);
  conversation.send(TcpSide::Server, Bytes(3000, 'a'), 3'000'000);
  conversation.close(4'000'000);
  ASSERT_EQ(frames.size(), 3U + 2U + 4U + 3U);
  const auto syn = tcp(frames[0]), syn_ack = tcp(frames[1]), ack = tcp(frames[2]);
  EXPECT_EQ(syn.flags(), Tins::TCP::SYN);
  EXPECT_EQ(syn.seq(), 77U);
  EXPECT_EQ(syn.dport(), 2112);
  EXPECT_EQ(syn_ack.flags(), Tins::TCP::SYN | Tins::TCP::ACK);
  EXPECT_EQ(syn_ack.seq(), 0xFFFFFFF0U);
  EXPECT_EQ(syn_ack.ack_seq(), 78U);
  EXPECT_EQ(ack.ack_seq(), 0xFFFFFFF1U);
  const auto first = tcp(frames[5]), second = tcp(frames[6]), third = tcp(frames[7]), answer = tcp(frames[8]);
  EXPECT_EQ(first.seq(), 0xFFFFFFF1U);
  EXPECT_EQ(second.seq(), 0xFFFFFFF1U + 1460) << "wraps";
  EXPECT_EQ(third.seq(), 0xFFFFFFF1U + 2920);
  EXPECT_EQ(third.rfind_pdu<Tins::RawPDU>().payload().size(), 80U);
  EXPECT_EQ(first.ack_seq(), 98U);
  EXPECT_EQ(answer.ack_seq(), 0xFFFFFFF1U + 3000);
  EXPECT_EQ(answer.sport(), 50000);
  EXPECT_EQ(frames[7].time_ns, 3'000'000) << "the last segment completes";
  EXPECT_EQ(frames[6].time_ns, 3'000'000 - 80 * 80);
  EXPECT_LT(frames[5].time_ns, frames[6].time_ns);
  for (const auto& frame : frames) expect_right_checksums(frame, false, 6);
}

TEST(TcpConversation, SpeaksIpv6) {
  std::vector<Frame> frames;
  TcpConversation conversation(kLaser6, kHub6, into(frames));
  conversation.send(TcpSide::Server, Bytes(101, 'a'), 0);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(tcp(frames[0]).sport(), 2112);
  for (const auto& frame : frames) expect_right_checksums(frame, true, 6);
}

TEST(DatagramSender, SendsOneDatagram) {
  std::vector<Frame> frames;
  DatagramSender({"192.168.0.10", 4001}, {"192.168.0.100", 4000}, into(frames)).send(Bytes(33, 'p'), 5);
  DatagramSender({"fe80::a", 4001}, {"fe80::64", 4000}, into(frames)).send(Bytes(33, 'p'), 5);
  ASSERT_EQ(frames.size(), 2U);
  const Tins::EthernetII ethernet(frames[0].bytes.data(), static_cast<std::uint32_t>(frames[0].bytes.size()));
  const auto& udp = ethernet.rfind_pdu<Tins::UDP>();
  EXPECT_EQ(udp.sport(), 4001);
  EXPECT_EQ(udp.dport(), 4000);
  EXPECT_EQ(udp.length(), 41);
  expect_right_checksums(frames[0], false, 17);
  expect_right_checksums(frames[1], true, 17);
}

TEST(NetworkFrames, RefuseAddressesThatAreNone) {
  const FrameSink nowhere = [](std::int64_t, ByteView) {};
  EXPECT_THROW(TcpConversation({"192.168.0.300", 1}, kHub, nowhere), Error);
  EXPECT_THROW(TcpConversation({"laser", 1}, kHub, nowhere), Error);
  EXPECT_THROW(DatagramSender(kLaser1, kHub6, nowhere), Error);
}

TEST(FrameSorter, PutsFramesIntoTheOrderOfTheirTimes) {
  std::vector<std::int64_t> times;
  FrameSorter sorter([&](std::int64_t t, ByteView) { times.push_back(t); }, 100);
  for (const std::int64_t t : {50, 10, 80, 70, 130}) sorter.push(t, Bytes(1));
  EXPECT_THAT(times, ElementsAre(10));
  sorter.push(151, Bytes(1));
  EXPECT_THAT(times, ElementsAre(10, 50));
  sorter.finish();
  EXPECT_THAT(times, ElementsAre(10, 50, 70, 80, 130, 151));
}

}  // namespace
}  // namespace crisp
