// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/scans/passes_stage.hpp"

#include <fmt/format.h>

#include <cmath>

#include "pipeline/data/degree.hpp"
#include "pipeline/plot/write_plot.hpp"
#include "plugins/scans/about_level.hpp"
#include "plugins/scans/told_in_passes.hpp"

namespace crisp {
namespace {

constexpr double kStandsOut = 3;       // standard errors
constexpr double kSureOfParts = 0.01;  // p below which the parts of a pass contradict each other

/// The two longest passes in opposite directions, up first; nothing where there are none.
std::optional<std::pair<Pass, Pass>> opposite(const std::vector<Pass>& passes) {
  const auto longest = [&](bool up) -> const Pass* {
    const Pass* best = nullptr;
    for (const auto& pass : passes) {
      if (pass.up == up && (best == nullptr || pass.scans.size() > best->scans.size())) best = &pass;
    }
    return best;
  };
  const Pass* up = longest(true);
  const Pass* down = longest(false);
  if (up == nullptr || down == nullptr) return {};
  return std::pair(*up, *down);
}

/// A number as the format shows it, or that it could not be told.
std::string shown(double value, const char* format) {
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : "unknown";
}

std::string in_degrees(const std::vector<std::pair<double, double>>& values) {
  std::string text;
  for (const auto& [value, error] : values) {
    text += fmt::format("{}{} ± {}", text.empty() ? "" : ", ", shown(value / kDegree, "{:+.3f}"),
                        shown(error / kDegree, "{:.3f}"));
  }
  return text;
}

}  // namespace

std::string in_words(const std::string& laser, const PassShift& found, double step, std::size_t beams) {
  std::string answers;
  for (const auto& [put_in, answer] : found.answers) {
    answers += fmt::format("{}{:+.4f}: {}", answers.empty() ? "" : ", ", put_in / kDegree,
                           shown(answer / kDegree, "{:+.4f}"));
  }
  const Gain& gain = found.gain;
  return fmt::format(
      "{}: down = up shifted by {} ± {} deg ({} steps), ranges off by {} mm, over {} beams\n"
      "  quarters of the angles: {} deg; of the beams: {} deg; p {} that it is the same everywhere\n"
      "  on other angles the passes differ by {} -> {} mm (change {} .. {})\n"
      "  put in by hand: what it answered [deg]: {}; in all {} times",
      laser, shown(found.shift / kDegree, "{:+.4f}"), shown(found.std_error / kDegree, "{:.4f}"),
      shown(found.shift / step, "{:.2f}"), shown(1e3 * found.offset, "{:+.1f}"), beams,
      in_degrees(found.by_angle), in_degrees(found.by_beam), shown(found.constant_p, "{:.3g}"),
      shown(1e3 * gain.before, "{:.2f}"), shown(1e3 * gain.after, "{:.2f}"),
      shown(1e3 * gain.ci95[0], "{:.2f}"), shown(1e3 * gain.ci95[1], "{:.2f}"), answers,
      shown(found.answer_ratio, "{:.3f}"));
}

namespace {

void tell(const std::string& laser, const PassShift& found, double step, std::size_t beams,
          Context& context) {
  context.say(in_words(laser, found, step, beams));
  context.report({{laser,
                   {{"shift", found.shift},
                    {"std_error", found.std_error},
                    {"steps", found.shift / step},
                    {"offset", found.offset},
                    {"constant_p", found.constant_p},
                    {"by_angle", found.by_angle},
                    {"by_beam", found.by_beam},
                    {"answers", found.answers},
                    {"answer_ratio", found.answer_ratio}}}});
}

/// A measure that does not answer to what is put in by hand says nothing.
bool is_believed(const PassShift& found) {
  constexpr double kWithin = 0.1;
  return std::isfinite(found.shift) && found.std_error > 0 && std::abs(found.answer_ratio - 1) <= kWithin;
}

bool stands_out(const PassShift& found) { return std::abs(found.shift) >= kStandsOut * found.std_error; }

/// A shift between the passes has no name of its own: what it may be called.
void add_findings(const std::string& laser, const PassShift& found, Findings& findings) {
  if (!is_believed(found)) {
    findings.unobservable.push_back({"encoder.backlash",
                                     fmt::format("{}: shifts between passes that are put in by hand do not "
                                                 "come back; {} deg was read, with an error of {} deg",
                                                 laser, shown(found.shift / kDegree, "{:+.3f}"),
                                                 shown(found.std_error / kDegree, "{:.3f}")),
                                     ""});
    return;
  }
  if (!stands_out(found)) return;
  const bool pays = found.gain.surely_falls();
  if (found.constant_p < kSureOfParts) {
    findings.unnamed.push_back({.covariate = "direction of the actuator, not the same at all its angles",
                                .quantity = "plate angle",
                                .scope = "plate",
                                .amplitude = std::abs(found.shift) / 2,
                                .unit = "rad",
                                .p_value = found.constant_p,
                                .gain = {found.gain},
                                .accepted = pays});
    return;
  }
  Finding finding{.cause = "encoder.backlash", .scope = "plate"};
  finding.parameters = {{"delta", "rad", -found.shift / 2, found.std_error / 2, true}};
  finding.explained_fraction = found.gain.explained();
  const AboutLevel none = about_level({{found.shift, found.std_error}}, Level::kZero, kPassBlocks);
  finding.log10_odds = none.log10_odds;  // a lag instead is as likely, and named beside it
  finding.p_value = none.p_value;
  finding.confounded_with = {laser + ".eta"};
  finding.told_apart_by = {"both ways gone at another speed: play stays, a lag shifts them by more"};
  finding.gain = {found.gain};
  finding.accepted = pays;
  findings.findings.push_back(std::move(finding));
}

/// Angles of the way up less half of the shift, and of the way down with half of it.
PlateTrajectory mended(const PlateTrajectory& plate, double shift) {
  const auto angles = plate.angles();
  std::vector<double> moved(angles.begin(), angles.end());
  double direction = 0;
  for (std::size_t i = angles.size();
       i-- > 0;) {  // backwards: where it goes next is what it was placed for …
    if (i + 1 < angles.size() && angles[i + 1] != angles[i]) direction = angles[i + 1] > angles[i] ? 1 : -1;
    moved[i] -= direction * shift / 2;
  }
  for (std::size_t i = 1; i < angles.size() && angles[i] != angles[i - 1]; ++i) {
    // … but a reading that stands alone came from the one before
    moved[i] = angles[i] - (angles[i] > angles[i - 1] ? 1 : -1) * shift / 2;
  }
  return plate.with_angles(std::move(moved));
}

/// The shift, with two standard errors either way.
PlotMark mark_of(const PassShift& found) {
  return {.at = found.shift / kDegree,
          .around = std::isfinite(found.std_error) ? 2 * found.std_error / kDegree : 0,
          .name = fmt::format("{}: {:+.3f} ± {} deg", is_believed(found) ? "found" : "read, not believed",
                              found.shift / kDegree, shown(found.std_error / kDegree, "{:.3f}"))};
}

void draw(const std::filesystem::path& folder, const std::string& laser, const PassComparison& comparison,
          const PassShift& found, Context& context) {
  Plot plot{.title = laser + ": pass down against pass up",
            .x_label = "shift between them [deg]",
            .y_label = "standard deviation of the differences [mm]",
            .marks = {mark_of(found)}};
  std::vector<std::size_t> all;
  for (std::size_t b = 0; b < comparison.blocks.size(); ++b) all.push_back(b);
  constexpr std::size_t kQuarters = 4;
  for (std::size_t q = 0; q <= kQuarters; ++q) {
    std::vector<std::size_t> some;
    for (const auto b : all) {
      if (q == kQuarters || comparison.blocks[b].angle_part * kQuarters / kAngleParts == q) some.push_back(b);
    }
    PlotSeries series{.name = q == kQuarters ? "all" : fmt::format("quarter {} of the angles", q + 1)};
    for (int k = -kReach; k <= kReach; ++k) {
      series.x.push_back(k * comparison.step / kDegree);
      series.y.push_back(1e3 * std::sqrt(variance_at(comparison, some, k * comparison.step)));
    }
    plot.series.push_back(std::move(series));
  }
  write_plots(folder / (laser + "_passes.svg"), {plot}, context);
}

}  // namespace

void DiagnosePassesStage::describe(StageDescription<DiagnosePassesStage>& d) {
  d.name("diagnose.passes").summary("asks whether an actuator that turns back is where it says on both ways");
  d.details(
      "For a laser on an actuator that goes up and down again. Each beam of the way down is laid over those "
      "of the way "
      "up at angles around it; where the variance of their differences is least, the two ways agree. Unlike "
      "a "
      "regression on measured slopes that does not come out short by their noise; shifts that are put in by "
      "hand are "
      "shown beside it.\n\n"
      "Play (`encoder.backlash`) and a lag between the clocks shift the ways alike as long as both are gone "
      "at one "
      "speed; so the two are named together. A shift that is not the same at all angles is `unnamed`. The "
      "measurements "
      "are given on with half of the shift on either way: which way is right cannot be seen.");
  d.takes<Scan>().takes<PlateReading>().takes<Measurements>().holds<PlateTrajectory>();
  d.takes<Findings>(Need::optional).gives<Findings>().gives<PlateTrajectory>().gives<Measurements>();
  d.option("shortest", &DiagnosePassesStage::shortest_, "way that counts as a pass")
      .unit("rad")
      .range(1e-4, 1e4);
  d.option("mend", &DiagnosePassesStage::mend_,
           "whether the trajectory that it gives has the angles that were found");
  d.option("folder", &DiagnosePassesStage::folder_, "where plots go; auto: nowhere")
      .writes_into({"*_passes.svg"});
}

void DiagnosePassesStage::process(const Inputs& in, Outputs&, Context&) {
  if (const Findings* before = in.find<Findings>()) findings_.append(*before);
  if (auto plate = in.share<PlateTrajectory>()) plate_ = std::move(plate);
  if (const auto* reading = in.find<PlateReading>()) series_.add(*reading);
  if (auto scan = in.share<Scan>(); scan && scan->laser == 0) series_.add(std::move(scan));
  if (auto beams = in.share<Measurements>()) beams_.push_back(std::move(beams));
}

double DiagnosePassesStage::diagnose(Findings& findings, Context& context) const {
  const std::string& name = context.rig().lasers.front().name;
  const auto actuator = series_.actuator(context.rig().plate);
  const auto say_nothing = [&](const std::string& why) {
    findings.unobservable.push_back({"encoder.backlash", fmt::format("{}, by passes: {}", name, why), ""});
    context.say(name + ": its angles cannot be checked by passes: " + why);
    return 0.0;
  };
  const auto passes = find_passes(series_, actuator, shortest_);
  if (passes.empty()) {
    return say_nothing(
        fmt::format("the actuator is never on its way for {:g} deg at a stretch", shortest_ / kDegree));
  }
  const auto both = opposite(passes);
  if (!both) return say_nothing("the actuator goes only one way: each surface is seen once");
  const auto& [up, down] = *both;
  const auto comparison = compare_passes(up, down);
  const PassShift found = find_shift(up, down, context.seed());
  if (!std::isfinite(found.shift)) {
    return say_nothing(
        fmt::format("the differences between the ways, of {} beams, have no least value within {:.3g} deg",
                    comparison.beams, kReach * comparison.step / kDegree));
  }
  tell(name, found, comparison.step, comparison.beams, context);
  add_findings(name, found, findings);
  const bool pays = is_believed(found) && stands_out(found) && found.gain.surely_falls();
  if (is_believed(found)) {
    add_likeness({told_in_passes(found, pays)}, findings);
    context.say(likeness_in_words(findings));
  }
  findings.unobservable.push_back(
      {name + ".tau",
       "both ways see the same surfaces from the same angles: that says nothing of the mounting", ""});
  if (folder_) draw(*folder_, name, comparison, found, context);
  return pays && mend_ ? found.shift : 0;
}

void DiagnosePassesStage::finish(Outputs& out, Context& context) {
  if (!plate_ || series_.scans().empty()) throw Error("no scans with readings of an actuator came");
  Findings own;
  const double shift = diagnose(own, context);
  findings_.append(own);
  out.give(std::move(findings_));
  out.give(mended(*plate_, shift));
  for (const auto& beams : beams_) out.give(beams);
}

}  // namespace crisp
