// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "grabbers/live/live_source.hpp"
#include "grabbers/pcl/source_grabber.hpp"
#include "pipeline/data/calibration.hpp"
#include "pipeline/data/cloud.hpp"
#include "pipeline/model/mirror_angle_cache.hpp"
#include "pipeline/model/sensor_model.hpp"
#include "plugins/assemble/revolutions.hpp"
#include "plugins/clock/online_aligner.hpp"

namespace crisp {

/// From items to clouds, as clock.online, assemble.deskew and assemble.revolutions do.
struct CloudSettings {
  OnlineSettings online;
  RevolutionSettings revolutions;
  TermRegistry terms = {};  ///< that the calibration names
};

/// Any source of items as a pcl::Grabber of clouds: to the signals of SourceGrabber it adds
///
///     void(const pcl::PointCloud<crisp::Point>::ConstPtr&)
///
/// one cloud a revolution of the plate, in its frame, as soon as the revolution is complete.
class CloudGrabber : public SourceGrabber {
 public:
  using CloudCallback = void(const Cloud::ConstPtr&);

  /// @param rig  whose devices the source's items come from
  /// @throws Error if the calibration has not the lasers of the rig in its order, or names a term that is not
  /// known
  CloudGrabber(std::string name, Open open, Rig rig, Calibration calibration, CloudSettings settings = {});
  ~CloudGrabber() noexcept override;

  void start() override;

 protected:
  void take(const HubItem& item) override;
  void end() override;

 private:
  void place(const Measurements& scan);

  Rig rig_;
  SensorModel model_;
  KnownMirrors mirrors_;
  CloudSettings settings_;
  boost::signals2::signal<CloudCallback>* cloud_signal_;
  std::optional<OnlineAligner> aligner_;
  std::optional<Revolutions> revolutions_;
  PlateTrajectory plate_;  ///< over the scan that is placed next
};

/// The devices of a rig over the network as a pcl::Grabber of clouds. It runs until stop().
class LiveCloudGrabber : public CloudGrabber {
 public:
  /// start() connects. @throws Error as CloudGrabber; start() throws what LiveSource does
  LiveCloudGrabber(const Rig& rig, Calibration calibration, LiveSettings live = {},
                   CloudSettings settings = {});
};

}  // namespace crisp
