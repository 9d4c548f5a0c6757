// SPDX-License-Identifier: BSD-3-Clause
#include <utility>

#include <crisp/live_grabber.hpp>

#include "grabbers/live/live_source.hpp"

namespace crisp {

LiveGrabber::LiveGrabber(Rig rig, LiveSettings settings)
    : SourceGrabber("LiveGrabber", [rig = std::move(rig), settings = std::move(settings)] {
        return std::make_unique<live::LiveSource>(rig, settings);
      }) {}

}  // namespace crisp
