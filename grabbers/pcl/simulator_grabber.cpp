// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/pcl/simulator_grabber.hpp"

#include <cmath>

#include <crisp/error.hpp>

#include "grabbers/pcl/paced_source.hpp"
#include "grabbers/simulate/recording.hpp"

namespace crisp {
namespace {

/// The hub's simulated data, one item after the other.
class SimulatedSource final : public ItemSource {
 public:
  SimulatedSource(const RecordingSettings& settings, const Scene& scene, const TermRegistry& terms)
      : simulator_(settings, scene, terms) {}

  std::optional<HubItem> next() override {
    const auto event = simulator_.next();
    if (!event) return {};
    if (const auto* reading = std::get_if<PlateReading>(&*event)) return *reading;
    return std::make_shared<const Scan>(to_scan(std::get<LaserTelegram>(*event)));
  }

 private:
  RecordingSimulator simulator_;
};

std::unique_ptr<ItemSource> open(const RecordingSettings& settings, const Scene& scene, double speed,
                                 const TermRegistry& terms) {
  auto source = std::make_unique<SimulatedSource>(settings, scene, terms);
  if (speed == 0) return source;
  return std::make_unique<PacedSource>(std::move(source), speed);
}

}  // namespace

SimulatorGrabber::SimulatorGrabber(const RecordingSettings& settings, const Scene& scene, double speed,
                                   const TermRegistry& terms)
    : SourceGrabber("SimulatorGrabber",
                    [settings, scene, speed, terms] { return open(settings, scene, speed, terms); }),
      truth_(RecordingSimulator(settings, scene, terms).truth()) {
  if (!std::isfinite(speed) || speed < 0) {
    throw Error("a simulation cannot be played at that speed",
                "give the speed relative to real time, or 0 for as fast as possible");
  }
}

}  // namespace crisp
