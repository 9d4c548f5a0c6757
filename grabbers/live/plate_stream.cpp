// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/live/plate_stream.hpp"

#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/serial_port.hpp>
#include <utility>

#include "grabbers/live/restartable_timer.hpp"

namespace crisp::live {
namespace {

using boost::asio::serial_port;
using boost::asio::ip::tcp;
using boost::system::error_code;

constexpr std::uint16_t kPlateServerPort = 4000;
constexpr std::size_t kPlatePiece = 4096;  // [bytes] read at once

/// A stream of sentences that is opened again whenever it ends. Link is a tcp::socket or a serial_port.
template <class Link>
class PlateStream final : public PlateReceiver {
 public:
  using Opened = std::function<void(const error_code&)>;
  using Open = std::function<void(Link&, Opened)>;

  PlateStream(boost::asio::io_context& context, PlateReadings readings, const PlateSettings& settings,
              Open open)
      : context_(context),
        readings_(std::move(readings)),
        silence_(settings.silence),
        open_(std::move(open)),
        link_(context),
        alarm_(context),
        back_off_(settings.max_reconnect_delay),
        buffer_(kPlatePiece) {}

  void start() override {
    ++link_number_;
    link_ = Link(context_);
    await_reading();
    open_(link_, [this, mine = link_number_](const error_code& failure) {
      if (mine != link_number_) return;
      if (failure) return fail(failure.message());
      read();
    });
  }

  void stop() override {
    if (std::exchange(stopped_, true)) return;
    close();
  }

 private:
  void read() {
    link_.async_read_some(boost::asio::buffer(buffer_),
                          [this, mine = link_number_](const error_code& failure, std::size_t bytes) {
                            if (mine != link_number_) return;
                            if (failure) return fail(failure.message());
                            if (readings_.take(wire::ByteView(buffer_).first(bytes))) {
                              back_off_.reset();
                              await_reading();
                            }
                            read();
                          });
  }

  void await_reading() {
    alarm_.set(silence_, [this] { fail("no reading came"); });
  }

  void fail(const std::string& reason) {
    close();
    readings_.note("connections that failed: " + reason);
    alarm_.set(back_off_.next(), [this] { start(); });
  }

  void close() {
    readings_.gap();
    ++link_number_;
    alarm_.cancel();
    error_code ignored;
    link_.close(ignored);
  }

  boost::asio::io_context& context_;
  PlateReadings readings_;
  double silence_;  ///< [s]
  Open open_;
  Link link_;
  std::uint64_t link_number_ = 0;  ///< callbacks of an earlier one are ignored
  RestartableTimer alarm_;
  BackOff back_off_;
  wire::Bytes buffer_;
  bool stopped_ = false;
};

error_code open_line(serial_port& line, const PlateSettings& settings) {
  error_code failure;
  line.open(settings.serial, failure);
  if (!failure) line.set_option(serial_port::baud_rate(settings.baud), failure);
  if (!failure) line.set_option(serial_port::character_size(8U), failure);
  if (!failure) line.set_option(serial_port::parity(serial_port::parity::none), failure);
  if (!failure) line.set_option(serial_port::stop_bits(serial_port::stop_bits::one), failure);
  if (!failure) line.set_option(serial_port::flow_control(serial_port::flow_control::none), failure);
  return failure;
}

}  // namespace

std::unique_ptr<PlateReceiver> plate_over_tcp(boost::asio::io_context& context, PlateReadings readings,
                                              const Address& plate, const PlateSettings& settings) {
  const tcp::endpoint server(ip_of(plate), plate.port == 0 ? kPlateServerPort : plate.port);
  return std::make_unique<PlateStream<tcp::socket>>(
      context, std::move(readings), settings,
      [server](tcp::socket& socket, auto opened) { socket.async_connect(server, std::move(opened)); });
}

std::unique_ptr<PlateReceiver> plate_over_serial_line(boost::asio::io_context& context,
                                                      PlateReadings readings, const PlateSettings& settings) {
  return std::make_unique<PlateStream<serial_port>>(
      context, std::move(readings), settings,
      [settings](serial_port& line, const auto& opened) { opened(open_line(line, settings)); });
}

}  // namespace crisp::live
