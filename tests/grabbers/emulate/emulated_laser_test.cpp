// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/emulate/emulated_laser.hpp"

#include <gtest/gtest.h>

#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/address.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <memory>
#include <vector>

#include "grabbers/wire/cola_encoding.hpp"

namespace crisp {
namespace {

using namespace crisp::emulate;
using namespace crisp::wire;
namespace asio = boost::asio;
using asio::ip::tcp;

/// How many of some clients get an answer when another has connected.
class Clients {
 public:
  explicit Clients(std::chrono::milliseconds longest_idle)
      : laser_(context_, {.ip = "127.0.0.1", .port = 0}, FaultDice({}, 0), EmulatedClock(), longest_idle) {
    laser_.start();
  }
  // NOLINTNEXTLINE(bugprone-exception-escape): what it throws ends the test program
  ~Clients() {
    laser_.stop();
    context_.poll();
  }
  Clients(const Clients&) = delete;
  Clients& operator=(const Clients&) = delete;

  void connect() {
    sockets_.push_back(std::make_unique<tcp::socket>(context_));
    sockets_.back()->connect({asio::ip::make_address("127.0.0.1"), laser_.port()});
    context_.run_for(std::chrono::milliseconds(1));
    context_.restart();
  }

  /// Whether the client that connected last is answered, and not shut out.
  bool last_is_answered() {
    const Bytes request = cola_message("sRN", "DeviceIdent", {}, ColaLanguage::B);
    boost::system::error_code failure;
    asio::write(*sockets_.back(), asio::buffer(request), failure);
    bool done = false;
    std::size_t got = 0;
    Bytes answer(1);
    asio::async_read(*sockets_.back(), asio::buffer(answer), [&](const auto&, std::size_t bytes) {
      done = true;
      got = bytes;
    });
    while (!done) context_.run_one();
    return got == 1;
  }

 private:
  asio::io_context context_;
  EmulatedLaser laser_;
  std::vector<std::unique_ptr<tcp::socket>> sockets_;
};

TEST(EmulatedLaser, AnswersAnotherClientThoughSixteenAreIdle) {
  Clients clients(std::chrono::milliseconds(0));
  for (int i = 0; i < 17; ++i) clients.connect();
  EXPECT_TRUE(clients.last_is_answered());
}

TEST(EmulatedLaser, ShutsOutASeventeenthClientWhileTheOthersWereActiveJustNow) {
  Clients clients(std::chrono::hours(1));
  for (int i = 0; i < 17; ++i) clients.connect();
  EXPECT_FALSE(clients.last_is_answered());
}

}  // namespace
}  // namespace crisp
