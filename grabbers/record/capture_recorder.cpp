// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/record/capture_recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include <crisp/error.hpp>

#include "grabbers/capture/capture_file.hpp"
#include "grabbers/capture/file_window.hpp"
#include "grabbers/capture/pcap_extent.hpp"
#include "grabbers/wire/scan_encoding.hpp"
#include "pipeline/data/internal_error.hpp"

namespace crisp::record {
namespace {

using capture::FrameOrigin;

constexpr std::int64_t kMillisecond = 1'000'000;
constexpr std::int64_t kHold = 20 * kMillisecond;  // longer than any frame lies before or behind its item
constexpr std::int64_t kHandshake = 5 * kMillisecond;
constexpr std::size_t kAtOnce = 4096;  // items that are written before the pause is over
constexpr std::size_t kMaxWaiting =
    40000;  // items: a minute's of three lasers at 50 Hz and a plate at 500 Hz

/// @throws Error  if the file cannot be read
FrameOrigin origin_of_file(const std::filesystem::path& file) {
  constexpr std::size_t kMagic = 4;
  capture::FileWindow(file).peek(kMagic);
  try {
    capture::CaptureFile capture(file);
    const capture::Packet* first = capture.next();
    return first == nullptr ? FrameOrigin::Recorded : capture::origin_of(first->bytes);
  } catch (const Error&) {  // no capture at all
    return FrameOrigin::Foreign;
  }
}

/// Not so /dev/stdout, nor a link to a pipe.
bool is_link_to_file(const std::filesystem::path& file) {
  std::error_code none;
  if (!std::filesystem::is_symlink(file, none)) return false;
  if (std::filesystem::read_symlink(file, none).string().starts_with("/proc/")) return false;
  return std::filesystem::is_regular_file(file, none) || !std::filesystem::exists(file, none);
}

bool is_there(const std::filesystem::path& file) {
  std::error_code none;
  return std::filesystem::is_regular_file(file, none) && std::filesystem::file_size(file, none) > 0;
}

/// A note on a recording that is about to be continued; empty if it is sound.
std::string note_on(const std::filesystem::path& file, const capture::PcapExtent& extent) {
  if (extent.whole < extent.bytes)
    return fmt::format(
        "{} ended within a record, as after a crash or a power cut: the {} bytes of that record were cut off",
        file.string(), extent.bytes - extent.whole);
  if (extent.damaged_records > 0)
    return fmt::format(
        "{} is damaged: {} bytes of it in {} places are unreadable. The recording continues at its end",
        file.string(), extent.damaged_bytes, extent.damaged_records);
  return {};
}

}  // namespace

void refuse_foreign(const std::filesystem::path& file) {
  if (is_link_to_file(file))
    throw Error(file.string() + " is a symbolic link, which is not recorded into",
                "name the file that it leads to, or remove the link");
  if (!is_there(file)) return;
  const FrameOrigin origin = origin_of_file(file);
  if (origin == FrameOrigin::Recorded) return;
  throw Error(fmt::format("{} exists and is {}, which cannot be continued: only a recording of crisp can",
                          file.string(),
                          origin == FrameOrigin::Simulated ? "a simulated capture" : "of another program"),
              "give another name or folder, or move the file away");
}

/// One capture that is being written.
struct CaptureRecorder::File {
  File(const std::filesystem::path& path, const Rig& rig)
      : pcap(path, capture::PcapMode::Grow),
        sorter([this](std::int64_t ns, wire::ByteView frame) { pcap.write(ns, frame); }, kHold),
        hub(rig, ColaLanguage::B, [this](std::int64_t ns, wire::ByteView frame) { sorter.push(ns, frame); }),
        connected(rig.lasers.size()) {}

  void write(const Scan& scan) {
    if (!connected.at(scan.laser)) hub.connect(scan.laser, scan.receipt_ns - kHandshake);
    connected[scan.laser] = true;
    hub.telegram(scan.laser, wire::encode_scan_data(wire::to_scan_data(scan), ColaLanguage::B),
                 scan.receipt_ns);
  }

  void write(const PlateReading& reading) { hub.reading(reading); }

  void end() {
    hub.close(latest_ns.value_or(0) + kMillisecond);
    sorter.finish();
    pcap.close();
  }

  capture::PcapWriter pcap;
  capture::FrameSorter sorter;
  capture::HubTrafficEncoder hub;
  std::vector<bool> connected;
  std::optional<std::int64_t> first_ns, latest_ns;  ///< of the items
};

CaptureRecorder::CaptureRecorder(std::filesystem::path file, Rig rig, const RecorderSettings& settings)
    : first_(std::move(file)), rig_(std::move(rig)), settings_(settings) {
  open();
  data::BatchSettings batches{.enough = kAtOnce, .most = kMaxWaiting, .pause = settings_.safe_after / 2};
  if (settings_.safe_after == 0) batches = {};
  writer_.emplace(batches, [this](const std::vector<HubItem>& items) { record(items); });
}

CaptureRecorder::~CaptureRecorder() {
  try {
    close();
  } catch (const Error&) {  // close() reports it; the data on disk are intact all the same
  }
}

void CaptureRecorder::record(const std::vector<HubItem>& items) {
  for (const HubItem& item : items) record(item);
  if (items.empty()) file_->sorter.finish();  // nothing more seems to come
  const auto now = Clock::now();
  if (now - safe_until_ < std::chrono::duration<double>(settings_.safe_after / 2)) return;
  file_->pcap.flush();
  safe_until_ = now;
}

std::filesystem::path CaptureRecorder::next_path() {
  std::filesystem::path path = first_;
  if (++names_ > 1) {
    path.replace_filename(first_.stem().string() + "-" + std::to_string(names_) +
                          first_.extension().string());
  }
  return path;
}

void CaptureRecorder::open() {
  std::filesystem::path path = next_path();
  for (refuse_foreign(path); is_there(path); refuse_foreign(path = next_path())) {
    const capture::PcapExtent extent = capture::pcap_extent(path);
    if (extent.can_be_continued()) {
      if (auto note = note_on(path, extent); !note.empty()) notes_.push_back(std::move(note));
      break;
    }
    notes_.push_back(fmt::format(
        "{} is damaged: its last {} bytes are unreadable, and so would be anything written behind them. It stays unchanged, and the recording continues in another file",
        path.string(), extent.bytes - extent.whole));
  }
  file_ = std::make_unique<File>(path, rig_);
  file_->pcap.flush();  // readable from the beginning on
  files_.push_back(std::move(path));
}

void CaptureRecorder::rotate(std::int64_t now_ns) {
  const double seconds = file_->first_ns ? 1e-9 * static_cast<double>(now_ns - *file_->first_ns) : 0;
  const bool full =
      settings_.max_bytes > 0 && static_cast<double>(file_->pcap.bytes()) >= settings_.max_bytes;
  if (!full && (settings_.most_seconds == 0 || seconds < settings_.most_seconds)) return;
  end_file();
  open();
}

void CaptureRecorder::record(const HubItem& item) {
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
  ++recorded_;
}

void CaptureRecorder::write(HubItem item) {
  if (closed_) throw data::internal_error("a closed capture cannot be written to");
  writer_->push(std::move(item));
  if (settings_.safe_after == 0) writer_->drain();
}

void CaptureRecorder::end_file() {
  if (const auto file = std::exchange(file_, nullptr)) file->end();
}

void CaptureRecorder::close() {
  if (std::exchange(closed_, true)) return;
  writer_->drain();
  writer_.reset();
  end_file();
}

}  // namespace crisp::record
