// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include <crisp/error.hpp>
#include <crisp/simulator_grabber.hpp>

#include "grabbers/simulate/recording.hpp"
#include "grabbers/simulate/scenes.hpp"
#include "pipeline/pcl/paced_source.hpp"

namespace crisp {
namespace {

/// The hub's simulated data, one item after the other.
class SimulatedSource final : public ItemSource {
 public:
  SimulatedSource(const simulate::RecordingSettings& settings, const simulate::Scene& scene,
                  const TermRegistry& terms)
      : simulator_(settings, scene, terms) {}

  std::optional<HubItem> next() override {
    const auto event = simulator_.next();
    if (!event) return {};
    if (const auto* reading = std::get_if<PlateReading>(&*event)) return *reading;
    return std::make_shared<const Scan>(simulate::to_scan(std::get<simulate::LaserTelegram>(*event)));
  }

 private:
  simulate::RecordingSimulator simulator_;
};

simulate::RecordingSettings settings_of(const Simulation& simulation) {
  simulate::RecordingSettings settings;
  settings.scanner.rig = simulation.rig;
  settings.scanner.truth = simulation.truth;
  settings.scanner.duration = simulation.duration;
  settings.scanner.seed = simulation.seed;
  return settings;
}

std::unique_ptr<ItemSource> open(const Simulation& simulation, double speed, const TermRegistry& terms) {
  auto source = std::make_unique<SimulatedSource>(settings_of(simulation),
                                                  simulate::built_in_scene(simulation.scene), terms);
  if (speed == 0) return source;
  return std::make_unique<pcl_grabber::PacedSource>(std::move(source), speed);
}

}  // namespace

SimulatorGrabber::SimulatorGrabber(const Simulation& simulation, double speed, const TermRegistry& terms)
    : SourceGrabber("SimulatorGrabber",
                    [simulation, speed, terms] { return open(simulation, speed, terms); }) {
  if (!std::isfinite(speed) || speed < 0) {
    throw Error("a simulation cannot be played at that speed",
                "give the speed relative to real time, or 0 for as fast as possible");
  }
  open(simulation, 0, terms);  // throws now, not in the thread that start() makes
}

}  // namespace crisp
