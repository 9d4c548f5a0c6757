// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/pcl/cloud_grabber.hpp"

#include <algorithm>
#include <utility>

#include "pipeline/data/error.hpp"
#include "plugins/assemble/deskew.hpp"

namespace crisp {
namespace {

Calibration checked(const Rig& rig, Calibration calibration) {
  const auto same = [](const RigLaser& a, const LaserCalibration& b) { return a.name == b.name; };
  if (!std::ranges::equal(rig.lasers, calibration.lasers, same)) {
    throw Error("the calibration's lasers are not those of the rig, in its order",
                "give the calibration of this rig");
  }
  return calibration;
}

}  // namespace

CloudGrabber::CloudGrabber(std::string name, Open open, Rig rig, Calibration calibration,
                           CloudSettings settings)
    : SourceGrabber(std::move(name), std::move(open)),
      rig_(std::move(rig)),
      model_(checked(rig_, std::move(calibration)), settings.terms),
      settings_(std::move(settings)),
      cloud_signal_(createSignal<CloudCallback>()) {
  settings_.online = with_lags(settings_.online, model_.calibration());
}

CloudGrabber::~CloudGrabber() noexcept { CloudGrabber::stop(); }

void CloudGrabber::start() {
  if (!isRunning()) {
    aligner_.emplace(
        rig_, AlignmentSettings{.mirror_half_width = kOnlineMirror}, settings_.online,
        AlignmentSink{
            .trajectory = [this](PlateTrajectory plate) { plate_ = std::move(plate); },
            .measurements = [this](const std::shared_ptr<const Measurements>& scan) { place(*scan); }});
    revolutions_.emplace(settings_.revolutions,
                         [this](const Cloud::ConstPtr& cloud) { (*cloud_signal_)(cloud); });
  }
  SourceGrabber::start();
}

void CloudGrabber::take(const HubItem& item) {
  SourceGrabber::take(item);
  if (const auto* scan = std::get_if<std::shared_ptr<const Scan>>(&item)) {
    aligner_->add(*scan);
  } else {
    aligner_->add(std::get<PlateReading>(item));
  }
}

void CloudGrabber::end() {
  aligner_->finish();
  revolutions_->finish();
}

void CloudGrabber::place(const Measurements& scan) {
  revolutions_->add(*deskew(scan, plate_, model_, mirrors_).cloud, plate_);
}

LiveCloudGrabber::LiveCloudGrabber(const Rig& rig, Calibration calibration, LiveSettings live,
                                   CloudSettings settings)
    : CloudGrabber(
          "LiveCloudGrabber",
          [rig, live = std::move(live)] { return std::make_unique<LiveSource>(rig, live); }, rig,
          std::move(calibration), std::move(settings)) {}

}  // namespace crisp
