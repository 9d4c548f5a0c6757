// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/wire/scan_conversion.hpp"

#include <array>
#include <cmath>

#include "pipeline/data/degree.hpp"

namespace crisp::wire {
namespace {

constexpr double kMillimetre = 1e-3;
constexpr std::size_t kMaxEchoes = 5;

/// The n of DISTn or RSSIn, 0 for every other name.
std::size_t echo_number(const ChannelBlock& channel, std::string_view kind) {
  const std::string_view name = channel.name;
  if (!name.starts_with(kind) || name.size() != kind.size() + 1) return 0;
  const auto n = static_cast<std::size_t>(name.back() - '0');
  return n >= 1 && n <= kMaxEchoes ? n : 0;
}

/// Merges the channels of one telegram into one scan.
class Gathering {
 public:
  explicit Gathering(Scan& scan) : scan_(scan) {}

  void take(const ChannelBlock& channel) {
    if (const auto n = echo_number(channel, "DIST")) {
      if (agrees(channel)) ranges(channel, echo(n).ranges);
      has_ranges_[n - 1] = true;
      echoes_ = std::max(echoes_, n);
    } else if (const auto m = echo_number(channel, "RSSI")) {
      if (agrees(channel)) values(channel, echo(m).remissions);
      has_remissions_[m - 1] = true;
    }
  }

  ScanFailure finish() {
    if (failure_ != ScanFailure::None) return failure_;
    if (echoes_ == 0) return ScanFailure::NoDistances;
    scan_.echoes.resize(echoes_);
    for (std::size_t n = 0; n < echoes_; ++n) {  // what was not sent
      if (!has_ranges_[n]) scan_.echoes[n].ranges.assign(first_->raw.size(), 0);
      if (!has_remissions_[n]) scan_.echoes[n].remissions.clear();
    }
    scan_.start_angle = first_->start_angle / kUnitsPerDegree * data::kDegree;
    scan_.angle_step = exact_angle_step(first_->angle_step);
    return ScanFailure::None;
  }

 private:
  Echo& echo(std::size_t n) {
    if (scan_.echoes.size() < n) scan_.echoes.resize(n);
    return scan_.echoes[n - 1];
  }

  bool agrees(const ChannelBlock& channel) {
    if (!first_) first_ = &channel;
    constexpr double kTurn = 360 * kUnitsPerDegree;
    if (!std::isfinite(channel.scale) || !std::isfinite(channel.offset)) {
      failure_ = ScanFailure::BadScale;
    } else if (channel.raw.size() != first_->raw.size() || channel.start_angle != first_->start_angle ||
               channel.angle_step != first_->angle_step) {
      failure_ = ScanFailure::ChannelsDisagree;
    } else if (std::abs(double{1} * channel.start_angle) > kTurn ||
               (channel.angle_step == 0 && channel.raw.size() > 1) ||
               double{1} * channel.angle_step * static_cast<double>(channel.raw.size()) > 1.01 * kTurn) {
      failure_ = ScanFailure::BadAngles;
    }
    return failure_ == ScanFailure::None;
  }

  static void ranges(const ChannelBlock& channel, std::vector<float>& out) {
    const double scale = channel.scale * kMillimetre, offset = channel.offset * kMillimetre;
    out.resize(channel.raw.size());
    for (std::size_t i = 0; i < out.size(); ++i) {
      const auto range = static_cast<float>(channel.raw[i] * scale + offset);
      out[i] = ((channel.raw[i] >= kFirstDistance) & (range > 0)) ? range : 0.0F;  // branchless: by vectors
    }
  }

  static void values(const ChannelBlock& channel, std::vector<float>& out) {
    out.resize(channel.raw.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = channel.raw[i] * channel.scale + channel.offset;
  }

  Scan& scan_;
  const ChannelBlock* first_ = nullptr;
  std::size_t echoes_ = 0;
  std::array<bool, kMaxEchoes> has_ranges_{}, has_remissions_{};
  ScanFailure failure_ = ScanFailure::None;
};

}  // namespace

std::string_view to_string(ScanFailure failure) {
  switch (failure) {
    case ScanFailure::None:
      return "none";
    case ScanFailure::NoDistances:
      return "no distance channel";
    case ScanFailure::ChannelsDisagree:
      return "channels with different angles or numbers of values";
    case ScanFailure::BadScale:
      return "a scale factor or offset that is no finite number";
    case ScanFailure::BadAngles:
      return "angles beyond a full turn, or the same for all values";
  }
  return "unknown";
}

double exact_angle_step(std::uint16_t step) {
  constexpr double kParts = 24;
  const double parts = std::round(step * kParts / kUnitsPerDegree);
  const bool rounded = std::lround(parts * kUnitsPerDegree / kParts) == step;
  return (rounded ? parts / kParts : step / kUnitsPerDegree) * data::kDegree;
}

ScanFailure to_scan(const ScanData& data, std::uint16_t laser, std::int64_t receipt_ns, Scan& scan) {
  Gathering gathering(scan);
  for (const auto& channel : data.channels16) gathering.take(channel);
  for (const auto& channel : data.channels8) gathering.take(channel);
  const auto failure = gathering.finish();
  if (failure != ScanFailure::None) return failure;
  scan.laser = laser;
  scan.serial_number = data.serial_number;
  scan.device_status = data.device_status;
  scan.telegram_counter = data.telegram_counter;
  scan.scan_counter = data.scan_counter;
  scan.scan_time_us = data.scan_time_us;
  scan.transmission_time_us = data.transmission_time_us;
  scan.receipt_ns = receipt_ns;
  scan.scan_frequency = data.scan_frequency / 100.0;
  scan.encoders.clear();
  for (const auto& encoder : data.encoders) scan.encoders.push_back({encoder.position, encoder.speed});
  return ScanFailure::None;
}

}  // namespace crisp::wire
