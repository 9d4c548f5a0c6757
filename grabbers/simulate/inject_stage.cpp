// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/inject_stage.hpp"

#include <fmt/format.h>

#include "grabbers/simulate/scenario.hpp"

namespace crisp::simulate {

void InjectStage::describe(StageDescription<InjectStage>& d) {
  d.name("simulate.inject").summary("injects known effects into recorded scans, to validate a diagnosis");
  d.details(
      "A diagnosis is validated by its response to an effect of known size. Above `diagnose.clocks` or `diagnose.noise`, this stage changes the recorded scans as if their lasers had these effects as well. Encoder readings pass unchanged. `at` counts from the receipt of a laser's first scan.");
  d.takes<Scan>().takes<PlateReading>(Need::optional).gives<Scan>().gives<PlateReading>();
  d.option(
      "effects", &InjectStage::requested_,
      "effects to inject: `{range.step: {h: -1mm, at: 10s}, noise.normal: {sigma: 5mm}}`, named as in `crisp effects`: clock.drift, clock.step, latency.step, mirror.period, range.step, and noise.heavy_tail, normal, quantisation, range_dependent, remission_dependent and two_peaks; a laser's name in front restricts an effect to it");
}

std::vector<Effect> InjectStage::effects(const RunSettings& run) const {
  return read_effects(requested_, run.rig, injectable_effects(known_terms(run)));
}

void InjectStage::check(const RunSettings& run) const { effects(run); }

void InjectStage::process(const Inputs& in, Outputs& out, Context& context) {
  if (lasers_.empty()) {
    const Rig& rig = context.rig();
    const auto all = injected_effects(effects(context.run()), rig);
    for (std::size_t laser = 0; laser < all.size(); ++laser) {
      lasers_.emplace_back(all[laser], context.seed(), rig.lasers[laser].name + ".put_in");
    }
    for (const OptionGroup& effect : requested_) {
      for (const auto& entry : effect.entries) {
        context.print(fmt::format("injected: {}.{} = {}", effect.name, entry.name, entry.value));
      }
    }
  }
  if (const auto reading = in.share<PlateReading>()) out.give(reading);
  if (const auto scan = in.share<Scan>()) out.give(lasers_.at(scan->laser).changed(*scan));
}

}  // namespace crisp::simulate
