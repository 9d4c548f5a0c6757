// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include <crisp/calibration.hpp>
#include <crisp/clock_aligner.hpp>
#include <crisp/cloud.hpp>
#include <crisp/live_settings.hpp>
#include <crisp/revolutions.hpp>
#include <crisp/rig.hpp>
#include <crisp/source_grabber.hpp>
#include <crisp/term.hpp>

namespace crisp {

/// From items to clouds, as clock.online, assemble.deskew and assemble.revolutions do.
struct CloudSettings {
  OnlineSettings online;           ///< how stamps become hub times
  RevolutionSettings revolutions;  ///< what part of a turn is one cloud
  TermRegistry terms = {};         ///< that the calibration names
};

/// Any source of items as a pcl::Grabber of clouds: to the signals of SourceGrabber it adds
///
///     void(const pcl::PointCloud<crisp::Point>::ConstPtr&)
///
/// one cloud a revolution of the plate, in its frame, as soon as the revolution is complete.
class CloudGrabber : public SourceGrabber {
 public:
  /// The signal of a complete cloud.
  using CloudCallback = void(const Cloud::ConstPtr&);

  /// @param rig  whose devices the source's items come from
  /// @throws Error if the calibration has not the lasers of the rig in its order, or names a term that is not
  /// known
  CloudGrabber(std::string name, Open open, Rig rig, Calibration calibration, CloudSettings settings = {});
  ~CloudGrabber() noexcept override;

  /// Begins a new cloud with the first scan. @throws what opening the source throws
  void start() override;

 protected:
  void take(const HubItem& item) override;
  void end() override;

 private:
  class Assembly;
  std::unique_ptr<Assembly> assembly_;
};

/// The devices of a rig over the network as a pcl::Grabber of clouds. It runs until stop().
class LiveCloudGrabber : public CloudGrabber {
 public:
  /// start() connects. @throws Error as CloudGrabber; start() throws what LiveSource does
  LiveCloudGrabber(const Rig& rig, Calibration calibration, LiveSettings live = {},
                   CloudSettings settings = {});
};

}  // namespace crisp
