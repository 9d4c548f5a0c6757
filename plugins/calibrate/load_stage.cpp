// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/load_stage.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include <crisp/calibration_file.hpp>
#include <crisp/registrar.hpp>

#include "pipeline/model/term_faults.hpp"
#include "pipeline/model/terms_in.hpp"

namespace crisp::calibrate {

Calibration ordered_as(const Rig& rig, Calibration calibration) {
  std::vector<LaserCalibration> ordered;
  for (const auto& laser : rig.lasers) {
    const LaserCalibration* found = calibration.find(laser.name);
    if (!found) {
      throw Error("the calibration has no laser '" + laser.name + "', which the rig has",
                  "use the calibration of this rig, or give the lasers the same names in both");
    }
    ordered.push_back(*found);
  }
  calibration.lasers = std::move(ordered);
  return calibration;
}

namespace {

void check_direction(const Calibration& calibration, const Rig& rig, const std::filesystem::path& file) {
  const auto of_rig = rig.plate.direction;
  if (of_rig == CountDirection::automatic || of_rig == calibration.direction) return;
  const bool clockwise = calibration.direction == CountDirection::clockwise;
  throw Error(
      fmt::format(
          "the calibration {} is for an encoder that counts {}, but the rig's counts {}: the cloud would be the mirror image of the scene",
          file.string(), clockwise ? "clockwise" : "counter-clockwise",
          clockwise ? "counter-clockwise" : "clockwise"),
      "correct plate.direction in the rig, or calibrate again");
}

}  // namespace

void LoadCalibrationStage::describe(StageDescription<LoadCalibrationStage>& d) {
  d.name("calibrate.load").summary("loads a calibration from a file");
  d.gives<Calibration>();
  d.option("file", &LoadCalibrationStage::file_, "calibration file in YAML").required();
}

void LoadCalibrationStage::process(const Inputs&, Outputs& out, Context& context) {
  if (!std::filesystem::exists(file_)) {
    throw Error("there is no calibration " + file_.string(),
                "configs/calibrate.yaml makes one; set the option file, or --set calibrate.load.file=FILE");
  }
  const auto& terms = context.run().registrar->get<TermRegistry>();
  const Calibration read =
      read_calibration(file_, model::judge_by(terms), [&](const Error& old) { context.warn(old.what()); });
  context.reads(file_);
  check_direction(read, context.rig(), file_);
  Calibration calibration = ordered_as(context.rig(), read);
  if (read.lasers.size() > calibration.lasers.size()) {
    context.warn("the calibration has lasers that the rig does not have; they are not used");
  }
  for (const auto& caveat : read.caveats) {
    context.mark_untrusted(
        fmt::format("the calibration {} was already untrusted when it was made: {}", file_.string(), caveat));
  }
  for (const auto& lost : calibration.unobservable) {
    if (lost.combination.empty()) continue;
    context.warn(fmt::format(
        "{} was not determined: {}; determined is {}. Where the plate turns at another speed than during the calibration, the cloud has the resulting error",
        lost.parameter, lost.reason, lost.combination));
  }
  const auto counts_from = [](CountsFrom from) {
    return [from](const TermInfo& term) { return term.counts_from == from; };
  };
  const auto from_begin = model::terms_in(calibration, terms, counts_from(CountsFrom::kRunsEpoch));
  if (!from_begin.empty()) {
    context.warn(fmt::format(
        "{}: a term of the time since a recording began is valid for the calibrated recording only",
        fmt::join(from_begin, ", ")));
  }
  const auto from_zero = model::terms_in(calibration, terms, counts_from(CountsFrom::kEncodersZero));
  if (!from_zero.empty()) {
    context.print(fmt::format(
        "{}: a term of the plate's angle is valid as long as the encoder counts from the same zero",
        fmt::join(from_zero, ", ")));
  }
  out.give(std::move(calibration));
}

}  // namespace crisp::calibrate
