// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include <crisp/capture_reader.hpp>
#include <crisp/source_grabber.hpp>

namespace crisp {

/// Settings for playing a capture.
struct PlaySettings {
  double speed = 0;         ///< times real time; 0: as fast as the callbacks take it
  CaptureSettings capture;  ///< how its bytes are understood
};

/// A capture of the hub's network interface as a pcl::Grabber; for its signals see SourceGrabber.
class CaptureGrabber : public SourceGrabber {
 public:
  /// The file is opened by start().
  /// @throws Error if the speed is negative or no number
  explicit CaptureGrabber(std::filesystem::path file, Rig rig = default_rig(), PlaySettings settings = {});
  ~CaptureGrabber() noexcept override;

  /// Statistics of the capture, by the last complete run.
  CaptureStatistics statistics() const;

 protected:
  void end() override;

 private:
  std::unique_ptr<ItemSource> open();

  std::filesystem::path file_;
  Rig rig_;
  PlaySettings settings_;
  CaptureReader* reader_ = nullptr;  ///< owned by the source that the base holds
  mutable std::mutex statistics_mutex_;
  CaptureStatistics statistics_;
};

}  // namespace crisp
