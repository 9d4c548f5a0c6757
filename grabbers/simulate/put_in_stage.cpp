// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/put_in_stage.hpp"

#include <fmt/format.h>

#include "grabbers/simulate/world.hpp"

namespace crisp {

void PutInStage::describe(StageDescription<PutInStage>& d) {
  d.name("simulate.put_in").summary("puts a known change into recorded scans, to see what a measure answers");
  d.details(
      "A measure that says what is wrong with a scanner is to be believed if it answers to a change whose "
      "size is "
      "known. In front of `diagnose.stamps` or `diagnose.noise` this stage changes the scans that were "
      "recorded as "
      "if their lasers had had these effects, too. A plate's readings pass as they are. `at` counts from the "
      "receipt of a laser's first scan.");
  d.takes<Scan>().takes<PlateReading>(Need::optional).gives<Scan>().gives<PlateReading>();
  d.option(
      "effects", &PutInStage::wanted_,
      "what to put in: `{range.step: {h: -1mm, at: 10s}, noise.normal: {sigma: 5mm}}`, by the names that "
      "`crisp "
      "effects` lists: clock.drift, clock.step, latency.step, mirror.period, range.step, and of noise "
      "heavy_tail, "
      "normal, quantisation, range_dependent, remission_dependent and two_peaks; an owner in front makes it "
      "one laser's");
}

std::vector<Effect> PutInStage::effects(const RunSettings& run) const {
  return read_effects(wanted_, run.rig, put_in_catalogue(known_terms(run)));
}

void PutInStage::check(const RunSettings& run) const { effects(run); }

void PutInStage::process(const Inputs& in, Outputs& out, Context& context) {
  if (lasers_.empty()) {
    const Rig& rig = context.rig();
    const auto all = put_in_effects(effects(context.run()), rig);
    for (std::size_t laser = 0; laser < all.size(); ++laser) {
      lasers_.emplace_back(all[laser], context.seed(), rig.lasers[laser].name + ".put_in");
    }
    for (const OptionGroup& effect : wanted_) {
      for (const auto& entry : effect.entries) {
        context.say(fmt::format("put in: {}.{} = {}", effect.name, entry.name, entry.value));
      }
    }
  }
  if (const auto reading = in.share<PlateReading>()) out.give(reading);
  if (const auto scan = in.share<Scan>()) out.give(lasers_.at(scan->laser).changed(*scan));
}

}  // namespace crisp
