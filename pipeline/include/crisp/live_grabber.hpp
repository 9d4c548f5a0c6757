// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crisp/live_settings.hpp>
#include <crisp/rig.hpp>
#include <crisp/source_grabber.hpp>

namespace crisp {

/// The devices of a rig over the network as a pcl::Grabber; for its signals see SourceGrabber. It runs until
/// stop().
class LiveGrabber : public SourceGrabber {
 public:
  /// start() connects. @throws nothing; start() throws what LiveSource does
  explicit LiveGrabber(Rig rig, LiveSettings settings = {});
};

}  // namespace crisp
