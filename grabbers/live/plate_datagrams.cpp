// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/live/plate_datagrams.hpp"

#include <fmt/format.h>

#include <utility>

#include <crisp/error.hpp>

namespace crisp::live {
namespace {

constexpr std::uint16_t kPlatePort = 4000;
constexpr std::size_t kLargestDatagram = 64 * 1024;
constexpr int kKernelBuffer =
    1 << 20;  // [bytes] what may wait while the hub is busy; the kernel may give less

}  // namespace

PlateDatagrams::PlateDatagrams(boost::asio::io_context& context, PlateReadings readings, const Address& plate,
                               const PlateSettings& settings)
    : readings_(std::move(readings)), plate_(ip_of(plate)), socket_(context), buffer_(kLargestDatagram) {
  const std::uint16_t port = settings.port.value_or(plate.port == 0 ? kPlatePort : plate.port);
  const boost::asio::ip::udp::endpoint at(ip_of({settings.listen, port}), port);
  boost::system::error_code failure;
  socket_.open(at.protocol(), failure);
  if (!failure) socket_.bind(at, failure);
  if (failure) {
    throw Error(
        fmt::format("cannot listen for the plate at {}:{}: {}", settings.listen, port, failure.message()),
        "give an address of this machine, and a port that no other program uses");
  }
  port_ = socket_.local_endpoint().port();
  socket_.set_option(boost::asio::socket_base::receive_buffer_size(kKernelBuffer), failure);
}

void PlateDatagrams::receive() {
  socket_.async_receive_from(boost::asio::buffer(buffer_), from_,
                             [this](const boost::system::error_code& failure, std::size_t bytes) {
                               if (failure == boost::asio::error::operation_aborted) return;
                               if (!failure) take(bytes);
                               if (socket_.is_open()) receive();
                             });
}

void PlateDatagrams::take(std::size_t bytes) {
  if (from_.address() != plate_) return readings_.note("datagrams from other addresses than the plate's");
  readings_.take(wire::ByteView(buffer_).first(bytes));
  readings_.gap();
}

void PlateDatagrams::stop() {
  if (!socket_.is_open()) return;
  boost::system::error_code ignored;
  socket_.close(ignored);
}

}  // namespace crisp::live
