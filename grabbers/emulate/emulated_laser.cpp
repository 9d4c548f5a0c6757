// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/emulate/emulated_laser.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/ip/address.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <deque>
#include <utility>

#include <crisp/error.hpp>

#include "grabbers/wire/cola_framer.hpp"

namespace crisp::emulate {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

constexpr std::size_t kMaxWaiting = 4 << 20;  // [bytes] for a client that does not read
constexpr std::size_t kMaxSessions = 16;

}  // namespace

/// One client.
class EmulatedLaser::Session : public std::enable_shared_from_this<Session> {
 public:
  Session(tcp::socket socket, EmulatedDevice& device, FaultDice& dice, EmulatedLedger& ledger)
      : socket_(std::move(socket)),
        timer_(socket_.get_executor()),
        responder_(device),
        dice_(dice),
        ledger_(ledger),
        buffer_(4096) {}

  void read() {
    socket_.async_read_some(asio::buffer(buffer_),
                            [self = shared_from_this()](const error_code& failure, std::size_t bytes) {
                              if (failure) return self->close();
                              self->take(bytes);
                              self->read();
                            });
  }

  void send(wire::Bytes telegram) {
    waiting_bytes_ += telegram.size();
    waiting_.push_back(std::move(telegram));
    if (waiting_.size() == 1) begin_telegram();
  }

  void close() {
    error_code ignored;
    socket_.close(ignored);
    timer_.cancel();
  }

  bool open() const { return socket_.is_open(); }
  /// When it last sent something or took what was sent to it.
  std::chrono::steady_clock::time_point active() const { return active_; }
  bool wants_scans() const { return open() && responder_.wants_scans(); }
  ColaLanguage language() const { return responder_.language(); }
  std::size_t waiting_bytes() const { return waiting_bytes_; }

 private:
  void take(std::size_t bytes) {
    active_ = std::chrono::steady_clock::now();
    framer_.feed(wire::ByteView(buffer_).first(bytes), 0, [this](const wire::ColaFrame& frame) {
      const auto request = wire::parse_cola(frame.payload, frame.language);
      if (request) send(responder_.answer(*request));
    });
  }

  void begin_telegram() {
    if (!dice_.stalls()) return write();
    ++ledger_.stalled;
    timer_.expires_after(
        std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(dice_.stall())));
    timer_.async_wait([self = shared_from_this()](const error_code& failure) {
      if (!failure) self->write();
    });
  }

  void write() {
    const wire::Bytes& telegram = waiting_.front();
    const std::size_t piece = dice_.piece(telegram.size() - written_);
    asio::async_write(socket_, asio::buffer(telegram.data() + written_, piece),
                      [self = shared_from_this()](const error_code& failure, std::size_t bytes) {
                        if (failure) return self->close();
                        self->has_written(bytes);
                      });
  }

  void has_written(std::size_t bytes) {
    active_ = std::chrono::steady_clock::now();
    written_ += bytes;
    if (written_ < waiting_.front().size()) return write();
    waiting_bytes_ -= written_;
    written_ = 0;
    waiting_.pop_front();
    if (!waiting_.empty()) begin_telegram();
  }

  tcp::socket socket_;
  asio::steady_timer timer_;
  SickResponder responder_;
  FaultDice& dice_;         ///< of the laser, which outlives its sessions
  EmulatedLedger& ledger_;  ///< likewise
  wire::Bytes buffer_;
  wire::ColaFramer framer_;
  std::deque<wire::Bytes> waiting_;
  std::size_t waiting_bytes_ = 0;
  std::size_t written_ = 0;  ///< [bytes] of the first that waits
  std::chrono::steady_clock::time_point active_ = std::chrono::steady_clock::now();
};

EmulatedLaser::EmulatedLaser(asio::io_context& context, const Address& address, FaultDice dice,
                             const EmulatedClock& clock, std::chrono::milliseconds longest_idle)
    : acceptor_(context), dice_(std::move(dice)), clock_(clock), longest_idle_(longest_idle) {
  error_code failure;
  const auto ip = asio::ip::make_address(address.ip, failure);
  const tcp::endpoint at(ip, address.port);
  if (!failure) acceptor_.open(at.protocol(), failure);
  if (!failure) acceptor_.set_option(tcp::acceptor::reuse_address(true), failure);
  if (!failure) acceptor_.bind(at, failure);
  if (!failure) acceptor_.listen(tcp::acceptor::max_listen_connections, failure);
  if (failure) {
    throw Error(
        fmt::format("cannot listen at {}:{}: {}", address.ip, address.port, failure.message()),
        "give a rig whose lasers have addresses of this machine, such as configs/loopback.yaml, and ports that no other program uses");
  }
  port_ = acceptor_.local_endpoint().port();
}

EmulatedLaser::~EmulatedLaser() = default;

void EmulatedLaser::accept() {
  acceptor_.async_accept([this](const error_code& failure, tcp::socket socket) {
    if (failure == asio::error::operation_aborted) return;
    std::erase_if(sessions_, [](const auto& session) { return !session->open(); });
    if (sessions_.size() == kMaxSessions) close_idle();
    if (!failure && sessions_.size() < kMaxSessions) {
      error_code ignored;
      socket.set_option(tcp::no_delay(true), ignored);
      sessions_.push_back(std::make_shared<Session>(std::move(socket), device_, dice_, ledger_));
      sessions_.back()->read();
    }
    if (acceptor_.is_open()) accept();
  });
}

/// Idle clients must not keep others out.
void EmulatedLaser::close_idle() {
  const auto active_after = std::chrono::steady_clock::now() - longest_idle_;
  std::erase_if(sessions_, [&](const auto& session) {
    if (session->active() > active_after) return false;
    session->close();
    return true;
  });
}

void EmulatedLaser::stop() {
  error_code ignored;
  acceptor_.close(ignored);
  for (const auto& session : sessions_) session->close();
  sessions_.clear();
}

void EmulatedLaser::restart() {
  ++ledger_.restarted;
  clock_.restart();
  device_.range.reset();  // nothing was stored
  device_.configured.reset();
  device_.every_beam = 1;
  for (const auto& session : sessions_) session->close();
}

void EmulatedLaser::send(wire::ScanData scan) {
  if (dice_.restarts()) restart();
  clock_.stamp(scan);
  device_.last = scan;
  if (!device_.measuring || subscribers() == 0) {
    ++ledger_.unheard;
    return;
  }
  if (!device_.sends(scan)) return;
  scan = device_.sent(std::move(scan));
  for (const auto& session : sessions_) {
    if (session->wants_scans()) send(*session, scan);
  }
}

void EmulatedLaser::send(Session& session, const wire::ScanData& scan) {
  if (session.waiting_bytes() > kMaxWaiting) {
    ++ledger_.missed;
    return;
  }
  if (dice_.drops()) {
    ++ledger_.dropped;
    return session.close();
  }
  wire::Bytes telegram = wire::encode_scan_data(scan, session.language());
  const bool damaged = dice_.damages();
  if (damaged) dice_.flip_a_bit(telegram);
  ++(damaged ? ledger_.damaged : ledger_.delivered);
  session.send(std::move(telegram));
}

std::size_t EmulatedLaser::subscribers() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(sessions_, [](const auto& session) { return session->wants_scans(); }));
}

std::size_t EmulatedLaser::waiting_bytes() const {
  std::size_t most = 0;
  for (const auto& session : sessions_) {
    if (session->open()) most = std::max(most, session->waiting_bytes());
  }
  return most;
}

}  // namespace crisp::emulate
