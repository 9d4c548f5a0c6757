// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/record/capture_recorder.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include "grabbers/wire/plate_sentence.hpp"
#include "grabbers/wire/scan_encoding.hpp"
#include "pipeline/data/error.hpp"

namespace crisp {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;
constexpr std::int64_t kHold = 20 * kMillisecond;  // longer than any frame lies before or behind its item
constexpr std::int64_t kHandshake = 5 * kMillisecond;

}  // namespace

/// One capture that is being written.
struct CaptureRecorder::File {
  File(const std::filesystem::path& path, const Rig& rig)
      : pcap(path, PcapMode::Grow),
        sorter([this](std::int64_t ns, ByteView frame) { pcap.write(ns, frame); }, kHold),
        hub(rig, ColaLanguage::B, [this](std::int64_t ns, ByteView frame) { sorter.push(ns, frame); }),
        connected(rig.lasers.size()) {}

  void write(const Scan& scan) {
    if (!connected.at(scan.laser)) hub.connect(scan.laser, scan.receipt_ns - kHandshake);
    connected[scan.laser] = true;
    hub.telegram(scan.laser, encode_scan_data(to_scan_data(scan), ColaLanguage::B), scan.receipt_ns);
  }

  void write(const PlateReading& reading) {
    hub.datagram(as_bytes(encode_plate_sentence(reading)), reading.receipt_ns);
  }

  void end() {
    hub.close(latest_ns.value_or(0) + kMillisecond);
    sorter.finish();
    pcap.close();
  }

  PcapWriter pcap;
  std::function<void()> sync = pcap.syncer();
  FrameSorter sorter;
  HubTraffic hub;
  std::vector<bool> connected;
  /// Hands to the operating system what was written. Of what is held for its order, only once nothing more
  /// seems to come.
  void flush() {
    if (!written) sorter.finish();
    written = false;
    pcap.flush();
  }

  std::optional<std::int64_t> first_ns, latest_ns;  ///< of the items
  bool written = false;                             ///< since it was made safe
};

CaptureRecorder::CaptureRecorder(std::filesystem::path file, Rig rig, const RecorderSettings& settings)
    : first_(std::move(file)), rig_(std::move(rig)), settings_(settings) {
  open();
  if (settings_.safe_after > 0)
    keeper_ = std::jthread([this](const std::stop_token& stop) { keep_safe(stop); });
}

CaptureRecorder::~CaptureRecorder() {
  try {
    close();
  } catch (const Error&) {  // close() tells it to those who ask; what is on the disk is whole all the same
    file_.reset();
  }
}

void CaptureRecorder::keep_safe(const std::stop_token& stop) {
  const std::chrono::duration<double> pause(settings_.safe_after / 2);
  std::unique_lock lock(mutex_);
  while (!ended_.wait_for(lock, stop, pause, [&] { return stop.stop_requested(); })) {
    if (!file_) continue;
    try {
      file_->flush();
      const auto sync = file_->sync;
      lock.unlock();  // the disk may take its time
      sync();
      lock.lock();
    } catch (const Error&) {
      if (!lock.owns_lock()) lock.lock();
      failure_ = std::current_exception();
      return;
    }
  }
}

void CaptureRecorder::open() {
  std::filesystem::path path = first_;
  if (!files_.empty()) {
    path.replace_filename(first_.stem().string() + "-" + std::to_string(files_.size() + 1) +
                          first_.extension().string());
  }
  file_ = std::make_unique<File>(path, rig_);
  files_.push_back(std::move(path));
}

void CaptureRecorder::rotate(std::int64_t now_ns) {
  const double seconds = file_->first_ns ? 1e-9 * static_cast<double>(now_ns - *file_->first_ns) : 0;
  const bool full =
      settings_.most_bytes > 0 && static_cast<double>(file_->pcap.bytes()) >= settings_.most_bytes;
  if (!full && (settings_.most_seconds == 0 || seconds < settings_.most_seconds)) return;
  end_file();
  open();
}

void CaptureRecorder::write(const HubItem& item) {
  const std::lock_guard lock(mutex_);
  if (failure_) std::rethrow_exception(failure_);
  if (!file_) throw Error("a capture that was closed cannot be written to");
  const std::int64_t now_ns = receipt_ns(item);
  rotate(now_ns);
  File& file = *file_;
  if (!file.first_ns) file.first_ns = now_ns;
  file.latest_ns = std::max(file.latest_ns.value_or(now_ns), now_ns);
  if (const auto* scan = std::get_if<std::shared_ptr<const Scan>>(&item)) {
    file.write(**scan);
  } else {
    file.write(std::get<PlateReading>(item));
  }
  file.written = true;
  if (settings_.safe_after > 0) return;
  file.flush();
  file.sync();
}

void CaptureRecorder::end_file() {
  if (const auto file = std::exchange(file_, nullptr)) file->end();
}

void CaptureRecorder::close() {
  keeper_.request_stop();
  if (keeper_.joinable()) keeper_.join();
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
  end_file();
}

}  // namespace crisp
