// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/clocks/encoder_stage.hpp"

#include <fmt/format.h>

#include <cmath>

#include "pipeline/data/degree.hpp"
#include "plugins/diagnose/clocks/encoder_slips.hpp"
#include "plugins/diagnose/report/findings_report.hpp"

namespace crisp::diagnose {
namespace {

Finding finding_of(const EncoderSlip& slip, const EncoderSlips& all) {
  Finding finding{
      .cause = "encoder.slip",
      .scope = "plate",
      .parameters =
          {{.name = "by", .unit = "rad", .value = slip.by, .std_error = slip.by_std_error, .free = true},
           {.name = "at", .unit = "s", .value = slip.at, .std_error = slip.at_std_error, .free = true}},
      .p_value = slip.p_value,
      .confounded_with = {},
      .gain = {{.metric = "disagreement of passes over one plate angle",
                .unit = "rad",
                .before = all.rms_before,
                .after = all.rms_after,
                .ci95 = all.ci95}},
      .accepted = true};
  finding.explained_fraction = finding.gain.front().explained();
  if (!slip.is_in_readings) finding.confounded_with.emplace_back("base.motion");
  return finding;
}

}  // namespace

void DiagnoseEncoderStage::describe(StageDescription<DiagnoseEncoderStage>& d) {
  d.name("diagnose.encoder").summary("detects slips of the encoder, and corrects the plate's angles");
  d.details(
      "At the same plate angle a laser measures the same ranges. The stage registers the scans of each tenth of a second with earlier passes over the same angle. It searches the angle shifts between them for lasting steps (`encoder.slip`: a slipped coupling, lost or surplus counts), jointly with lags of the lasers, backlash and effects of the rate. It needs no calibration, but a plate that passes its angles more than once. The trajectory that it returns has the steps removed. A step that the encoder readings show within milliseconds is the encoder's. A slower one may be a rotation of the scanner on its base, and lists `base.motion` as its competing cause.");
  d.takes<Measurements>().takes<Findings>(Need::optional).holds<PlateTrajectory>();
  d.gives<PlateTrajectory>().gives<Measurements>().gives<Findings>();
  d.option("correct", &DiagnoseEncoderStage::correct_,
           "whether to remove the steps from the returned trajectory");
}

void DiagnoseEncoderStage::process(const Inputs& in, Outputs&, Context&) {
  if (const Findings* before = in.find<Findings>()) findings_.append(*before);
  auto beams = in.share<Measurements>();
  if (!beams) return;
  auto plate = in.share<PlateTrajectory>();
  collected_.add(beams, plate);
  batches_.emplace_back(std::move(plate), std::move(beams));
}

void DiagnoseEncoderStage::finish(Outputs& out, Context& context) {
  const estimate::Sample sample = collected_.sample();
  const EncoderSlips found = find_encoder_slips(
      sample.beams, *sample.plate, std::abs(context.rig().plate.angle_per_count()), context.seed());
  Findings own;
  for (const EncoderSlip& slip : found.slips) own.findings.push_back(finding_of(slip, found));
  if (found.tested == 0) {
    const std::string why = fmt::format("{} passes over the same plate angles are too few", found.shifts);
    own.unobservable.push_back({"plate.encoder.slip", why, ""});
    context.print("encoder.slip cannot be tested: " + why);
  } else if (found.slips.empty()) {
    context.print(fmt::format(
        "{} passes over the same plate angles show no slip of the encoder ({:.1f} s of the recording tested)",
        found.shifts, found.tested));
  }
  for (const Finding& finding : own.findings) context.print(in_words(finding));
  context.report({{"slips", found.slips.size()}, {"compared_passes", found.shifts}});
  findings_.append(own);
  out.give(std::move(findings_));
  const bool corrects = correct_ && !found.slips.empty();
  const PlateTrajectory* last = nullptr;
  for (const auto& [plate, beams] : batches_) {
    if (plate.get() != last && corrects) {
      out.give(without_slips(*plate, found.slips));
    } else if (plate.get() != last) {
      out.give(plate);
    }
    last = plate.get();
    out.give(beams);
  }
}

}  // namespace crisp::diagnose
