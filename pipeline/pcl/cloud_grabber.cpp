// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <optional>
#include <utility>

#include <crisp/cloud_grabber.hpp>
#include <crisp/deskew.hpp>
#include <crisp/error.hpp>
#include <crisp/sensor_model.hpp>

#include "grabbers/live/live_source.hpp"

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

/// From items to clouds.
class CloudGrabber::Assembly {
 public:
  using Give = std::function<void(const Cloud::ConstPtr&)>;

  Assembly(Rig rig, Calibration calibration, CloudSettings settings, Give give)
      : rig_(std::move(rig)),
        model_(checked(rig_, std::move(calibration)), settings.terms),
        settings_(std::move(settings)),
        give_(std::move(give)) {
    settings_.online = with_lags(settings_.online, model_.calibration());
  }

  /// What comes from now on is of another run.
  void begin() {
    aligner_.emplace(
        rig_, AlignmentSettings{.mirror_half_width = kOnlineMirror}, settings_.online,
        AlignmentSink{
            .trajectory = [this](PlateTrajectory plate) { plate_ = std::move(plate); },
            .measurements = [this](const std::shared_ptr<const Measurements>& scan) { place(*scan); }});
    revolutions_.emplace(settings_.revolutions, give_);
  }

  void take(const HubItem& item) {
    std::visit([&](const auto& each) { aligner_->add(each); }, item);
  }

  void end() {
    aligner_->finish();
    revolutions_->finish();
  }

 private:
  void place(const Measurements& scan) {
    revolutions_->add(*deskew(scan, plate_, model_, mirrors_).cloud, plate_);
  }

  Rig rig_;
  SensorModel model_;
  MirrorAngleCache mirrors_;
  CloudSettings settings_;
  Give give_;
  std::optional<OnlineAligner> aligner_;
  std::optional<Revolutions> revolutions_;
  PlateTrajectory plate_;  ///< over the scan that is placed next
};

CloudGrabber::CloudGrabber(std::string name, Open open, Rig rig, Calibration calibration,
                           CloudSettings settings)
    : SourceGrabber(std::move(name), std::move(open)),
      assembly_(std::make_unique<Assembly>(
          std::move(rig), std::move(calibration), std::move(settings),
          [signal = createSignal<CloudCallback>()](const Cloud::ConstPtr& cloud) { (*signal)(cloud); })) {}

CloudGrabber::~CloudGrabber() noexcept { CloudGrabber::stop(); }

void CloudGrabber::start() {
  if (!isRunning()) assembly_->begin();
  SourceGrabber::start();
}

void CloudGrabber::take(const HubItem& item) {
  SourceGrabber::take(item);
  assembly_->take(item);
}

void CloudGrabber::end() { assembly_->end(); }

LiveCloudGrabber::LiveCloudGrabber(const Rig& rig, Calibration calibration, LiveSettings live,
                                   CloudSettings settings)
    : CloudGrabber(
          "LiveCloudGrabber",
          [rig, live = std::move(live)] { return std::make_unique<live::LiveSource>(rig, live); }, rig,
          std::move(calibration), std::move(settings)) {}

}  // namespace crisp
