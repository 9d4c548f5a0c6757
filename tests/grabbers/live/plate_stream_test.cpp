// SPDX-License-Identifier: BSD-3-Clause
// The plate over TCP, and over a serial line that is a pseudo-terminal.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <termios.h>
#include <unistd.h>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <cstdlib>
#include <filesystem>

#include <crisp/error.hpp>

#include "grabbers/wire/plate_sentence.hpp"
#include "tests/grabbers/live/live_support.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::live;
using namespace crisp::wire;
namespace fs = std::filesystem;
using boost::asio::ip::tcp;

std::string sentence(unsigned k) {
  return encode_plate_sentence(
      {.sequence = static_cast<std::uint16_t>(k), .device_us = 2000 * k, .count = 32 * k});
}

std::string sentences(unsigned first, unsigned end) {
  std::string text;
  for (unsigned k = first; k < end; ++k) text += sentence(k);
  return text;
}

/// Expects the next reading to be number k.
void expect_reading(LiveSource& source, unsigned k) {
  const auto item = source.next_within(test::kPatience);
  ASSERT_TRUE(item) << "reading " << k;
  const auto& reading = std::get<PlateReading>(*item);
  EXPECT_EQ(reading.sequence, k);
  EXPECT_EQ(reading.device_us, 2000 * k);
  EXPECT_EQ(reading.count, 32 * k);
  EXPECT_GT(reading.receipt_ns, 1'700'000'000'000'000'000);
}

/// The far end of a serial line.
class PseudoTerminal {
 public:
  PseudoTerminal() : fd_(posix_openpt(O_RDWR | O_NOCTTY)) {
    if (fd_ < 0 || grantpt(fd_) != 0 || unlockpt(fd_) != 0) throw Error("there is no pseudo-terminal");
    termios settings{};
    tcgetattr(fd_, &settings);
    cfmakeraw(&settings);
    tcsetattr(fd_, TCSANOW, &settings);
  }
  ~PseudoTerminal() { close(fd_); }
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  fs::path name() const { return ptsname(fd_); }
  void write(const std::string& bytes) const {
    ASSERT_EQ(::write(fd_, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }

 private:
  int fd_;
};

class PlateStreams : public testing::Test {
 protected:
  static LiveSettings settings(PlateTransport transport) {
    return {.lasers = false,
            .plate_at = {.transport = transport, .silence = 600, .max_reconnect_delay = 0.1}};
  }
};

TEST_F(PlateStreams, OverASerialLineAreReadAndCountWhatIsDamaged) {
  const PseudoTerminal terminal;
  LiveSettings live = settings(PlateTransport::Serial);
  live.plate_at.serial = terminal.name();
  LiveSource source(test::loopback_rig(), live);
  const std::string first = sentence(0);
  terminal.write(first.substr(0, 5));
  terminal.write(first.substr(5) + sentence(1));
  std::string damaged = sentence(2);
  damaged[8] ^= 1;
  terminal.write("noise\r\n" + damaged + sentences(3, 20));
  expect_reading(source, 0);
  expect_reading(source, 1);
  for (unsigned k = 3; k < 20; ++k) expect_reading(source, k);
  const auto statistics = source.close();
  const auto& plate = test::of(statistics, "plate");
  EXPECT_EQ(plate.items, 19U);
  EXPECT_EQ(plate.losses.of("bytes outside of sentences"), 5U);
  EXPECT_EQ(test::count_beginning(plate.losses, "sentences refused"), 1U);
  EXPECT_EQ(plate.losses.of(kReadingsNeverCame), 1U);
}

TEST_F(PlateStreams, ComeBackWhenASerialLineIsPluggedInAgain) {
  const test::TemporaryFolder folder;
  const fs::path line = folder / "line";
  LiveSettings live = settings(PlateTransport::Serial);
  live.plate_at.serial = line;
  LiveSource source(test::loopback_rig(), live);  // before there is a line
  for (unsigned plug = 0; plug < 2; ++plug) {
    const PseudoTerminal terminal;
    fs::create_symlink(terminal.name(), line);
    terminal.write(sentences(10 * plug, 10 * plug + 10));
    for (unsigned k = 10 * plug; k < 10 * plug + 10; ++k) expect_reading(source, k);
    fs::remove(line);
  }
  const auto statistics = source.close();
  EXPECT_EQ(test::of(statistics, "plate").items, 20U);
  EXPECT_GT(test::count_beginning(test::of(statistics, "plate").notes, "connections that failed"), 0U);
}

TEST_F(PlateStreams, OverTcpGoOnAfterAConnectionBreaks) {
  boost::asio::io_context context;
  tcp::acceptor acceptor(context, {boost::asio::ip::make_address("127.0.0.1"), 0});
  Rig rig = test::loopback_rig();
  rig.plate.address.port = acceptor.local_endpoint().port();
  LiveSource source(rig, settings(PlateTransport::Tcp));
  for (unsigned connection = 0; connection < 3; ++connection) {
    tcp::socket plate = acceptor.accept();
    const std::string text = sentences(10 * connection, 10 * connection + 9) + sentence(99).substr(0, 10);
    boost::asio::write(plate, boost::asio::buffer(text));
    for (unsigned k = 10 * connection; k < 10 * connection + 9; ++k) expect_reading(source, k);
  }
  const auto statistics = source.close();
  const auto& plate = test::of(statistics, "plate");
  EXPECT_EQ(plate.items, 27U);
  EXPECT_EQ(plate.losses.of(kReadingsNeverCame), 2U);
  EXPECT_EQ(test::count_beginning(plate.losses, "sentences refused"), 3U)
      << "each connection ends within one";
  EXPECT_GE(test::count_beginning(plate.notes, "connections that failed"), 2U);
}

TEST_F(PlateStreams, AreOpenedAnewWhenNoReadingComes) {
  boost::asio::io_context context;
  tcp::acceptor acceptor(context, {boost::asio::ip::make_address("127.0.0.1"), 0});
  Rig rig = test::loopback_rig();
  rig.plate.address.port = acceptor.local_endpoint().port();
  LiveSettings live = settings(PlateTransport::Tcp);
  live.plate_at.silence = 0.05;
  LiveSource source(rig, live);
  EXPECT_TRUE(test::comes_true(source, "plate", [](const DeviceStatistics& plate) {
    return plate.notes.of("connections that failed: no reading came") >= 2;
  }));
}

}  // namespace
}  // namespace crisp
