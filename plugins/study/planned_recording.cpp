// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/study/planned_recording.hpp"

#include <utility>

#include <crisp/error.hpp>

#include "grabbers/simulate/device_effects.hpp"

namespace crisp::study {
namespace {

void add_effects(Calibration& truth, const OptionGroups& effects, const RunSettings& run) {
  const TermRegistry& terms = simulate::known_terms(run);
  simulate::add_terms(truth, simulate::read_effects(effects, run.rig, simulate::recording_catalogue(terms)),
                      terms);
}

}  // namespace

void PlannedRecording::check(const RunSettings& run) const {
  check_all(
      [&] {
        Calibration drawn = truth.drawn(run, run.seed);
        add_effects(drawn, truth.effects, run);
      },
      [&] { simulate::make_motion(scanner.motion, scanner.duration, run.seed); },
      [&] { scanner.field.beams(); },
      [&] {
        simulate::ScannerSettings planned = scanner;
        planned.rig = run.rig;
        kinds.apply(planned);
      });
}

PlannedRecording::Prepared PlannedRecording::prepared(Context& context) const {
  simulate::ScannerSettings planned = scanner;
  planned.rig = context.rig();
  kinds.apply(planned);
  planned.seed = context.seed();
  planned.truth = truth.load(context, planned.seed);
  add_effects(planned.truth, truth.effects, context.run());
  simulate::Motion motion = simulate::make_motion(planned.motion, planned.duration, planned.seed);
  return {.scanner = std::move(planned), .scene = scene.load(context), .motion = std::move(motion)};
}

}  // namespace crisp::study
