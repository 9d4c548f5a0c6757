// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/live/live_source.hpp"

#include <boost/asio/post.hpp>
#include <future>
#include <utility>

namespace crisp::live {

LiveSource::LiveSource(const Rig& rig, const LiveSettings& settings)
    : queue_(settings.queue), work_(context_.get_executor()) {
  if (settings.plate && rig.plate.encoder_of) wired_encoder_ = std::make_unique<devices::WiredEncoder>(rig);
  const auto give = [this, widths = settings.sick.encoder_widths](HubItem item) {
    const auto* scan = std::get_if<std::shared_ptr<const Scan>>(&item);
    if (scan != nullptr && wired_encoder_) {
      if (const auto reading = wired_encoder_->read(**scan, widths)) queue_.push(*reading);
    }
    queue_.push(std::move(item));
  };
  for (std::size_t i = 0; i < rig.lasers.size() && settings.lasers; ++i) {
    const RigLaser& laser = rig.lasers[i];
    logs_.push_back(std::make_unique<devices::DeviceLog>(DeviceKind::Laser, laser.name, laser.address,
                                                         static_cast<std::uint16_t>(i)));
    SickSettings sick = settings.sick;
    sick.configuration.encoder = rig.plate.encoder_of == i;
    lasers_.push_back(
        std::make_unique<SickClient>(context_, *logs_.back(), laser.address, sick, give, settings.clock));
  }
  if (settings.plate && !wired_encoder_) {
    logs_.push_back(
        std::make_unique<devices::DeviceLog>(DeviceKind::Plate, rig.plate.name, rig.plate.address));
    const bool is_stream = settings.plate_at.transport != PlateTransport::Datagrams;
    wire::PlateFramer framer(rig.plate.line,
                             is_stream ? wire::PlateBytes::stream : wire::PlateBytes::datagrams);
    plate_ =
        make_plate_receiver(context_, PlateReadings(*logs_.back(), give, settings.clock, std::move(framer)),
                            rig.plate.address, settings.plate_at);
  }
  for (const auto& laser : lasers_) laser->start();
  if (plate_) plate_->start();
  thread_ = std::thread([this] { context_.run(); });
}

LiveSource::~LiveSource() { end_thread(); }

void LiveSource::end_thread() {
  interrupt();
  work_.reset();
  if (thread_.joinable()) thread_.join();
}

CaptureStatistics LiveSource::close() {
  end_thread();
  return statistics();
}

std::optional<HubItem> LiveSource::next() {
  constexpr std::chrono::milliseconds kWhile{1000};
  while (!queue_.closed()) {
    if (auto item = queue_.pop(kWhile)) return item;
  }
  return {};
}

void LiveSource::interrupt() {
  boost::asio::post(context_, [this] {
    stop_devices();
    queue_.close();
  });
}

void LiveSource::stop_devices() {
  for (const auto& laser : lasers_) laser->stop();
  if (plate_) plate_->stop();
}

void LiveSource::in_thread(const std::function<void()>& work) {
  if (!thread_.joinable()) return work();
  std::promise<void> done;
  boost::asio::post(context_, [&] {
    work();
    done.set_value();
  });
  done.get_future().wait();
}

CaptureStatistics LiveSource::statistics() {
  CaptureStatistics result;
  in_thread([&] {
    for (const auto& log : logs_) result.devices.push_back(log->statistics());
    if (wired_encoder_) result.devices.push_back(wired_encoder_->statistics());
  });
  result.losses.add("items dropped because the pipeline was too slow", queue_.dropped());
  return result;
}

}  // namespace crisp::live
