// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <crisp/hub_item.hpp>
#include <crisp/rig.hpp>

#include "grabbers/capture/hub_traffic_encoder.hpp"
#include "grabbers/capture/pcap_writer.hpp"
#include "pipeline/data/batcher.hpp"

namespace crisp::record {

/// A recording that crisp wrote can be written on; a file that came from elsewhere, or that the simulator
/// wrote, stays as it is.
/// @throws Error  if there is such a file
void refuse_foreign(const std::filesystem::path& file);

struct RecorderSettings {
  double safe_after =
      0.5;  ///< [s] within which what was written is on the disk, whatever happens to the machine
  double max_bytes = 0;     ///< of a file, about; then the next is begun; 0: no limit
  double most_seconds = 0;  ///< of a file, by the items' receipt; 0: no limit
};

/// Records scans and readings as a capture of the hub's network interface: a reader gives them back
/// unchanged, times of receipt included. The file grows in place and holds whole records only, so that it is
/// readable whenever and however the writing ends. It is written in a thread of its own, so that nobody waits
/// for the disk, and is flushed soon, whether anything more comes or not.
class CaptureRecorder {
 public:
  /// @param file  the first one; the next are name-2.pcap, name-3.pcap … A recording that exists is written
  /// on, unless it is damaged so that nothing behind its end could be read; then the next one is.
  /// @throws Error  if it cannot be written, or is no recording of crisp's
  CaptureRecorder(std::filesystem::path file, Rig rig, const RecorderSettings& settings);
  ~CaptureRecorder();
  CaptureRecorder(const CaptureRecorder&) = delete;
  CaptureRecorder& operator=(const CaptureRecorder&) = delete;

  /// Waits for the disk only if a minute's items of three lasers wait for it already, or safe_after is 0.
  /// @throws Error  if the disk turned out to be full; what was written before is safe
  void write(HubItem item);
  /// Ends the file. @throws Error  likewise
  void close();

  // Once it is closed, or has thrown:
  const std::vector<std::filesystem::path>& files() const { return files_; }
  std::uint64_t recorded() const { return recorded_; }  ///< items
  /// Notes on existing recordings that were damaged.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  struct File;
  using Clock = std::chrono::steady_clock;
  void record(const std::vector<HubItem>& items);
  void record(const HubItem& item);
  void open();
  std::filesystem::path next_path();
  void rotate(std::int64_t now_ns);
  void end_file();

  std::filesystem::path first_;
  Rig rig_;
  RecorderSettings settings_;
  bool closed_ = false;

  // owned by the writing thread until it has finished
  std::vector<std::filesystem::path> files_;
  std::vector<std::string> notes_;
  std::size_t names_ = 0;  ///< that were used or passed over: hub.pcap, hub-2.pcap …
  std::uint64_t recorded_ = 0;
  std::unique_ptr<File> file_;
  Clock::time_point safe_until_;  ///< what came before is on the disk
  std::optional<data::Batcher<HubItem>> writer_;
};

}  // namespace crisp::record
