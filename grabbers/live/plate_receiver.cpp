// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/live/plate_receiver.hpp"

#include <fmt/format.h>

#include <utility>

#include "grabbers/capture/framing_losses.hpp"
#include "grabbers/live/endpoints.hpp"
#include "pipeline/data/error.hpp"

namespace crisp {
namespace {

namespace asio = boost::asio;
using asio::ip::udp;
using boost::system::error_code;

constexpr std::uint16_t kPlatePort = 4000;
constexpr std::size_t kLargestDatagram = 64 * 1024;
constexpr int kKernelBuffer =
    1 << 20;  // [bytes] what may wait while the hub is busy; the kernel may give less

}  // namespace

PlateReceiver::PlateReceiver(asio::io_context& context, DeviceLog& log, const Address& plate,
                             const PlateSettings& settings, Give give)
    : log_(log), plate_(ip_of(plate)), give_(std::move(give)), socket_(context), buffer_(kLargestDatagram) {
  const std::uint16_t port = settings.port.value_or(plate.port == 0 ? kPlatePort : plate.port);
  const udp::endpoint at(ip_of({settings.listen, port}), port);
  error_code failure;
  socket_.open(at.protocol(), failure);
  if (!failure) socket_.bind(at, failure);
  if (failure) {
    throw Error(
        fmt::format("cannot listen for the plate at {}:{}: {}", settings.listen, port, failure.message()),
        "give an address of this machine, and a port that no other program uses");
  }
  port_ = socket_.local_endpoint().port();
  socket_.set_option(asio::socket_base::receive_buffer_size(kKernelBuffer), failure);
}

void PlateReceiver::receive() {
  socket_.async_receive_from(asio::buffer(buffer_), from_,
                             [this](const error_code& failure, std::size_t bytes) {
                               if (failure == asio::error::operation_aborted) return;
                               if (!failure) take(bytes);
                               if (socket_.is_open()) receive();
                             });
}

void PlateReceiver::take(std::size_t bytes) {
  if (from_.address() != plate_) return log_.note("datagrams from another address than the plate's");
  const auto sink = [this](const PlateReading& reading) {
    if (const auto fresh = log_.take(reading)) give_(*fresh);
  };
  framer_.feed(ByteView(buffer_).first(bytes), now_ns(), sink);
  framer_.gap();
}

void PlateReceiver::stop() {
  if (!socket_.is_open()) return;
  note_framing(framer_.counts(), log_);
  error_code ignored;
  socket_.close(ignored);
}

}  // namespace crisp
