// SPDX-License-Identifier: BSD-3-Clause
// Peers that send garbage, telegrams without end, or nothing, and sources that are stopped meanwhile.
#include <gtest/gtest.h>

#include <boost/asio/write.hpp>
#include <future>
#include <memory>

#include <crisp/error.hpp>

#include "grabbers/emulate/emulator.hpp"
#include "grabbers/live/live_source.hpp"
#include "grabbers/wire/cola_encoding.hpp"
#include "grabbers/wire/plate_sentence.hpp"
#include "tests/grabbers/live/live_support.hpp"
#include "tests/support/simulated_items.hpp"

namespace crisp {
namespace {

using namespace crisp::emulate;
using namespace crisp::live;
using namespace crisp::wire;
using boost::asio::ip::tcp;
using boost::asio::ip::udp;
using test::of;
using test::rig_of_one;

const auto kLoopback = boost::asio::ip::make_address("127.0.0.1");
constexpr std::uint64_t kMuch = 1'000'000;  // [bytes]

Bytes bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

/// A server that accepts one client after the other, and sends each the same bytes without end or answer.
class Babbler {
 public:
  explicit Babbler(Bytes bytes) : bytes_(std::move(bytes)), acceptor_(context_, {kLoopback, 0}) {
    accept();
    thread_ = std::thread([this] { context_.run(); });
  }
  ~Babbler() {
    context_.stop();
    thread_.join();
  }
  Babbler(const Babbler&) = delete;
  Babbler& operator=(const Babbler&) = delete;
  std::uint16_t port() const { return acceptor_.local_endpoint().port(); }

 private:
  void accept() {
    acceptor_.async_accept([this](const boost::system::error_code& failure, tcp::socket socket) {
      if (failure) return;
      clients_.push_back(std::make_unique<tcp::socket>(std::move(socket)));
      babble(*clients_.back());
      accept();
    });
  }
  void babble(tcp::socket& socket) {
    if (bytes_.empty()) return;
    boost::asio::async_write(socket, boost::asio::buffer(bytes_),
                             [this, &socket](const boost::system::error_code& failure, std::size_t) {
                               if (!failure) babble(socket);
                             });
  }

  Bytes bytes_;
  boost::asio::io_context context_;
  tcp::acceptor acceptor_;
  std::vector<std::unique_ptr<tcp::socket>> clients_;
  std::thread thread_;
};

TEST(BadPeers, ThatSendGarbageOfAnyLengthForALaserAreCounted) {
  // What claims to be a telegram of 4 GB, and then what is none.
  Bytes garbage{2, 2, 2, 2, 0xff, 0xff, 0xff, 0xff, 's', 'S', 'N', ' '};
  garbage.resize(100'000, 0xab);
  const Babbler babbler(garbage);
  LiveSource source(rig_of_one(babbler.port()), {.plate = false, .sick = {.reply_timeout = 0.05}});
  EXPECT_TRUE(test::comes_true(source, "laser1", [](const DeviceStatistics& laser) {
    return laser.losses.of("bytes outside of whole telegrams") > kMuch &&
           laser.notes.of("connections that failed: a request was not answered") >= 2;
  }));
  const auto statistics = source.close();
  EXPECT_EQ(of(statistics, "laser1").items, 0U);
}

TEST(BadPeers, ThatSendTelegramsWithoutEndForALaserAreCounted) {
  // One in CoLa-A that never ends, and within it the beginnings of many in CoLa-B that are too long.
  std::string endless = "\x02sSN LMDscandata 1 1 ";
  for (int i = 0; i < 1000; ++i) endless += "7 \x02\x02\x02\x02\x7f\xff\xff\xff" + std::string(100, 'F');
  const Babbler babbler(bytes_of(endless));
  LiveSource source(rig_of_one(babbler.port()), {.plate = false, .sick = {.reply_timeout = 0.05}});
  EXPECT_TRUE(test::comes_true(source, "laser1", [](const DeviceStatistics& laser) {
    return laser.losses.of("bytes outside of whole telegrams") > kMuch;
  }));
  EXPECT_EQ(of(source.close(), "laser1").items, 0U);
}

/// Sentences without end, and what is none.
std::string nonsense_for_a_plate() {
  return "$PPLT," + std::string(5000, '7') + "\n" + std::string(5000, 'x') + "$$$";
}

TEST(BadPeers, ThatSendGarbageForAPlateOverTcpAreCountedAndConnectedToAnew) {
  const Babbler babbler(bytes_of(nonsense_for_a_plate()));
  Rig rig = test::loopback_rig();
  rig.plate.address.port = babbler.port();
  LiveSource source(
      rig, {.lasers = false,
            .plate_at = {.transport = PlateTransport::Tcp, .silence = 0.05, .max_reconnect_delay = 0.1}});
  EXPECT_TRUE(test::comes_true(source, "plate", [](const DeviceStatistics& plate) {
    return plate.losses.of("bytes outside of sentences") > kMuch &&
           test::count_beginning(plate.losses, "sentences refused") > 100 &&
           plate.notes.of("connections that failed: no reading came") >= 2;
  }));
  EXPECT_EQ(of(source.close(), "plate").items, 0U);
}

TEST(BadPeers, ThatSendGarbageForAPlateInDatagramsAreCountedAsItComes) {
  LiveSource source(test::loopback_rig(), {.lasers = false, .plate_at = {.port = 0}});
  boost::asio::io_context context;
  udp::socket plate(context, udp::v4());
  std::string garbage;
  while (garbage.size() + nonsense_for_a_plate().size() < 60'000) garbage += nonsense_for_a_plate();
  const auto sends = [&](const std::string& datagram) {
    plate.send_to(boost::asio::buffer(datagram), {kLoopback, source.plate_port()});
  };
  EXPECT_TRUE(test::comes_true(source, "plate", [&](const DeviceStatistics& so_far) {
    sends(garbage);
    return so_far.losses.of("bytes outside of sentences") > kMuch;
  }));
  sends(encode_plate_sentence({.sequence = 7}));
  while (const auto item = source.next_within(test::kPatience)) {
    EXPECT_EQ(std::get<PlateReading>(*item).sequence, 7U) << "what is sound is read all the same";
    break;
  }
  EXPECT_EQ(of(source.close(), "plate").items, 1U);
}

TEST(BadPeers, FromAnotherAddressThanThePlatesAreCountedAndNotRead) {
  Rig rig = test::loopback_rig();
  rig.plate.address.ip = "127.0.0.2";
  LiveSource source(rig, {.lasers = false, .plate_at = {.port = 0}});
  boost::asio::io_context context;
  udp::socket unknown(context, udp::endpoint(kLoopback, 0));
  EXPECT_TRUE(test::comes_true(source, "plate", [&](const DeviceStatistics& plate) {
    unknown.send_to(boost::asio::buffer(encode_plate_sentence({.sequence = 7})),
                    {kLoopback, source.plate_port()});
    return plate.notes.of("datagrams from other addresses than the plate's") > 0;
  }));
  EXPECT_EQ(of(source.close(), "plate").items, 0U);
}

/// An address at which connecting neither succeeds nor fails: the kernel takes no more clients for a server
/// that accepts none.
class BlackHole {
 public:
  BlackHole() : acceptor_(context_) {
    acceptor_.open(tcp::v4());
    acceptor_.bind({kLoopback, 0});
    acceptor_.listen(0);
    for (auto& client : clients_) {
      client.async_connect({kLoopback, port()}, [](const boost::system::error_code&) {});
    }
  }
  std::uint16_t port() const { return acceptor_.local_endpoint().port(); }

 private:
  boost::asio::io_context context_;
  tcp::acceptor acceptor_;
  std::array<tcp::socket, 4> clients_{tcp::socket(context_, tcp::v4()), tcp::socket(context_, tcp::v4()),
                                      tcp::socket(context_, tcp::v4()), tcp::socket(context_, tcp::v4())};
};

/// Nothing that a source waits for by itself is over in time.
LiveSettings patient() {
  constexpr double kForEver = 3600;  // [s]
  LiveSettings settings;
  settings.plate = false;
  settings.sick.reply_timeout = settings.sick.silence = settings.sick.max_reconnect_delay = kForEver;
  settings.plate_at = {
      .transport = PlateTransport::Tcp, .silence = kForEver, .max_reconnect_delay = kForEver};
  return settings;
}

/// Interrupts a source that somebody waits for. What it takes on an idle machine, milliseconds, is left as a
/// property: a busy one may take longer, but not as long as what the source waits for.
void expect_to_end_soon(LiveSource& source, const char* when) {
  auto waiting = std::async(std::launch::async, [&] {
    while (source.next()) {
    }
  });
  const auto begin = std::chrono::steady_clock::now();
  source.close();
  waiting.get();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  testing::Test::RecordProperty(when, std::to_string(1e3 * took.count()) + " ms");
  EXPECT_LT(took.count(), 30) << when;
}

TEST(LiveSourceEndsSoon, WhileNobodyAnswersItsConnection) {
  const BlackHole hole;
  LiveSource lasers(rig_of_one(hole.port()), patient());
  LiveSettings plate_alone = patient();
  plate_alone.lasers = false;
  plate_alone.plate = true;
  Rig rig = test::loopback_rig();
  rig.plate.address.port = hole.port();
  LiveSource plate(rig, plate_alone);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(of(lasers.statistics(), "laser1").notes, Counts()) << "it still connects";
  EXPECT_EQ(of(plate.statistics(), "plate").notes, Counts());
  expect_to_end_soon(lasers, "laser");
  expect_to_end_soon(plate, "plate");
}

TEST(LiveSourceEndsSoon, BetweenTwoTries) {
  LiveSource source(rig_of_one(1), patient());  // a port that nobody serves
  EXPECT_TRUE(test::comes_true(source, "laser1", [](const DeviceStatistics& laser) {
    return test::count_beginning(laser.notes, "connections that failed") >= 3;
  }));
  expect_to_end_soon(source, "pause");
}

TEST(LiveSourceEndsSoon, BeforeTheLaserHasSentAnything) {
  const Babbler silent({});
  LiveSource source(rig_of_one(silent.port()), patient());
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  expect_to_end_soon(source, "silence");
}

TEST(LiveSourceEndsSoon, WhileTheLoginIsNotAnswered) {
  const Babbler repeats_itself(cola_message("sRA", "SCdevicestate", {std::uint8_t{1}}, ColaLanguage::B));
  LiveSource source(rig_of_one(repeats_itself.port()), patient());
  EXPECT_TRUE(test::comes_true(source, "laser1", [](const DeviceStatistics& laser) {
    return laser.telegrams.of("sRA SCdevicestate") > 10;
  }));
  expect_to_end_soon(source, "login");
}

TEST(LiveSourceEndsSoon, WhileScansStreamAndGivesAllThatCame) {
  const auto items = test::simulated_items(0.3);
  Emulator emulator(test::loopback_rig(1), {.speed = 0});
  LiveSource source(emulator.rig(), patient());
  std::uint64_t sent = 0;
  for (const HubItem& item : items) {
    const auto* scan = std::get_if<std::shared_ptr<const Scan>>(&item);
    if (scan == nullptr || (*scan)->laser != 0) continue;
    emulator.send(item, [] { return false; });
    ++sent;
  }
  EXPECT_TRUE(
      test::comes_true(source, "laser1", [&](const DeviceStatistics& laser) { return laser.items == sent; }));
  const auto begin = std::chrono::steady_clock::now();
  source.close();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  RecordProperty("stream", std::to_string(1e3 * took.count()) + " ms");
  std::uint64_t came = 0;
  while (source.next_within({})) ++came;
  EXPECT_EQ(came, sent) << "what waited is still there";
}

}  // namespace
}  // namespace crisp
