// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "grabbers/live/live_source.hpp"
#include "grabbers/pcl/source_grabber.hpp"

namespace crisp {

/// The devices of a rig over the network as a pcl::Grabber; for its signals see SourceGrabber. It runs until
/// stop().
class LiveGrabber : public SourceGrabber {
 public:
  /// start() connects. @throws nothing; start() throws what LiveSource does
  explicit LiveGrabber(Rig rig, LiveSettings settings = {});
};

}  // namespace crisp
