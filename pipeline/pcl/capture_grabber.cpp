// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <utility>

#include <crisp/capture_grabber.hpp>
#include <crisp/error.hpp>

#include "pipeline/pcl/paced_source.hpp"

namespace crisp {

CaptureGrabber::CaptureGrabber(std::filesystem::path file, Rig rig, PlaySettings settings)
    : SourceGrabber("CaptureGrabber", [this] { return open(); }),
      file_(std::move(file)),
      rig_(std::move(rig)),
      settings_(std::move(settings)) {
  if (!std::isfinite(settings_.speed) || settings_.speed < 0) {
    throw Error("a capture cannot be played at that speed",
                "give the speed relative to real time, or 0 for as fast as possible");
  }
}

CaptureGrabber::~CaptureGrabber() noexcept { stop(); }

std::unique_ptr<ItemSource> CaptureGrabber::open() {
  auto reader = std::make_unique<CaptureReader>(file_, rig_, settings_.capture);
  reader_ = reader.get();
  if (settings_.speed == 0) return reader;
  return std::make_unique<pcl_grabber::PacedSource>(std::move(reader), settings_.speed);
}

void CaptureGrabber::end() {
  const std::lock_guard lock(statistics_mutex_);
  statistics_ = reader_->statistics();
}

CaptureStatistics CaptureGrabber::statistics() const {
  const std::lock_guard lock(statistics_mutex_);
  return statistics_;
}

}  // namespace crisp
