// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "grabbers/capture/hub_traffic.hpp"
#include "grabbers/capture/pcap_writer.hpp"
#include "grabbers/wire/hub_item.hpp"
#include "pipeline/data/rig.hpp"

namespace crisp {

struct RecorderSettings {
  double safe_after =
      0.5;  ///< [s] within which what was written is on the disk, whatever happens to the machine
  double most_bytes = 0;    ///< of a file, about; then the next is begun; 0: no limit
  double most_seconds = 0;  ///< of a file, by the items' receipt; 0: no limit
};

/// Writes scans and readings as the capture that the hub's network interface would have made of them: a
/// reader gives them back as they are, times of receipt included. The file grows in place and holds whole
/// records only, so that it can be read whenever and however the writing ends. A thread of its own puts it on
/// the disk, whether anything more comes or not.
class CaptureRecorder {
 public:
  /// @param file  the first one; the next are name-2.pcap, name-3.pcap … A file that exists is written on.
  /// @throws Error  if it cannot be written, or is no capture of this kind
  CaptureRecorder(std::filesystem::path file, Rig rig, const RecorderSettings& settings);
  ~CaptureRecorder();
  CaptureRecorder(const CaptureRecorder&) = delete;
  CaptureRecorder& operator=(const CaptureRecorder&) = delete;

  /// @throws Error  if the disk is full; what was written before is safe
  void write(const HubItem& item);
  /// Ends the file. @throws Error  likewise
  void close();

  const std::vector<std::filesystem::path>& files() const { return files_; }

 private:
  struct File;
  void open();
  void rotate(std::int64_t now_ns);
  void end_file();
  void keep_safe(const std::stop_token& stop);

  std::filesystem::path first_;
  Rig rig_;
  RecorderSettings settings_;
  std::vector<std::filesystem::path> files_;

  std::mutex mutex_;  ///< of what follows
  std::condition_variable_any ended_;
  std::unique_ptr<File> file_;
  std::exception_ptr failure_;  ///< of the thread
  std::jthread keeper_;
};

}  // namespace crisp
