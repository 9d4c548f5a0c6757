// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/scatter_stage.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <limits>
#include <span>
#include <utility>

#include "pipeline/estimate/free_parameters.hpp"
#include "pipeline/estimate/shared_errors.hpp"
#include "pipeline/plot/write_plot.hpp"
#include "pipeline/stage/registry.hpp"
#include "plugins/diagnose/comb.hpp"
#include "plugins/diagnose/edges.hpp"
#include "plugins/diagnose/evidence.hpp"
#include "plugins/diagnose/likelihood_gain.hpp"
#include "plugins/diagnose/noise.hpp"
#include "plugins/diagnose/noise_plots.hpp"
#include "plugins/diagnose/repeats.hpp"
#include "plugins/diagnose/report.hpp"
#include "plugins/diagnose/scatter.hpp"

namespace crisp {
namespace {

constexpr std::size_t kTooFew = 1000;  // ranges, to say how they scatter

/// @param noise  [m] within which surfaces are flat
Evidence all_of(const SensorModel& model, const Sample& sample, double noise) {
  SurfelSettings settings;
  settings.noise = noise;
  return {model, sample, settings, std::numeric_limits<std::size_t>::max()};
}

}  // namespace

void DiagnoseScatterStage::describe(StageDescription<DiagnoseScatterStage>& d) {
  d.name("diagnose.scatter").summary("says how the ranges of a turning scanner scatter, and what moved");
  d.details(
      "Follows each beam to the flat surface that it should have met, by a calibration that is right: put it "
      "behind diagnose.model. How the ranges of each laser scatter there is compared with the plain "
      "simulator's normal noise: growing with the range, the incidence or weak echoes, heavy tails, two "
      "peaks, steps (`noise.*`), or changing with incidence or remission otherwise (`unnamed`); each is "
      "judged by parts of the recording that it was not fitted to. At edges it looks for ranges between what "
      "is before and behind (`noise.mixed_pixels`), and it "
      "compares what the same directions show from turn to turn (`scene.moving`). Whether ranges on surfaces "
      "can "
      "still be told from simulated ones is said of all lasers together.");
  d.takes<Measurements>()
      .takes<Findings>(Need::optional)
      .holds<PlateTrajectory>()
      .holds<Calibration>()
      .gives<Findings>();
  d.option("noise", &DiagnoseScatterStage::noise_, "standard deviation of a range, about")
      .unit("m")
      .range(1e-6, 1);
  d.option("least_gain", &DiagnoseScatterStage::least_gain_,
           "by which a law of noise must raise the log-likelihood of a range that it was not fitted to: what "
           "brings less may be the surfaces' own roughness")
      .unit("nat")
      .range(0, 10);
  d.option("folder", &DiagnoseScatterStage::folder_,
           "where plots of each laser's noise go, and of what moved; auto: nowhere")
      .writes_into({"*_noise.svg", "scene_moving.svg"});
}

void DiagnoseScatterStage::process(const Inputs& in, Outputs&, Context& context) {
  if (const Findings* before = in.find<Findings>()) all_.append(*before);
  if (!in.find<Measurements>()) return;
  calibration_ = in.share<Calibration>();
  collected_.add(in.share<Measurements>(),
                 oriented_(in.share<PlateTrajectory>(), calibration_.get(), context.rig()));
}

void DiagnoseScatterStage::finish(Outputs& out, Context& context) {
  const Sample sample = longest_recording(collected_.sample());
  context.count("beams left out of the diagnosis of a long recording", collected_.left_out());
  const SensorModel model(*calibration_, context.run().registrar->get<TermRegistry>());
  const LagRange lag = lag_range(model, 0);
  context.progress(0, "following beams to their surfaces");
  const Evidence evidence = all_of(model, covered(sample, lag.earliest, lag.latest), noise_);
  const Measurements& beams = evidence.sample().beams;
  Followed all{.model = model,
               .evidence = evidence,
               .beams = beams,
               .points = evidence.beams().points,
               .met = met_by(evidence.surfels(), evidence.beams(), beams.range),
               .crowd = Crowd(evidence.beams().points),
               .blocks = recording_blocks(beams)};
  all.usual = usual_error(all.met);
  Findings found;
  std::vector<std::string> without_edges;
  for (std::size_t laser = 0; laser < model.lasers(); ++laser) {
    context.progress(static_cast<double>(laser) / static_cast<double>(model.lasers()), "fitting noise");
    if (context.interrupted()) return;
    if (add_laser(laser, all, found, context) == 0) without_edges.push_back(calibration_->lasers[laser].name);
  }
  if (!without_edges.empty()) {
    context.say(fmt::format("no edges were crossed by {}: of mixed pixels they tell nothing",
                            without_edges.size() == model.lasers()
                                ? std::string("any laser")
                                : fmt::format("{}", fmt::join(without_edges, ", "))));
  }
  const auto changing = changing_directions(beams, *evidence.sample().plate, all.met, all.usual);
  if (const auto moved = moving(changing, context.seed())) {
    found.findings.push_back(*moved);
    if (folder_) write_plots(*folder_ / "scene_moving.svg", {moving_plot(changing)}, context);
  }
  add_likeness(told_, found);
  for (const Finding& finding : found.findings) context.say(in_words(finding));
  for (const UnnamedFinding& finding : found.unnamed) context.say(in_words(finding));
  if (!told_.empty()) context.say(likeness_in_words(found));
  context.report({{"findings", found.findings.size()},
                  {"unnamed", found.unnamed.size()},
                  {"before_p", found.before_p},
                  {"after_p", found.after_p}});
  all_.append(found);
  out.give(std::move(all_));
}

std::size_t DiagnoseScatterStage::add_laser(std::size_t laser, const Followed& all, Findings& found,
                                            Context& context) {
  const std::string& name = calibration_->lasers[laser].name;
  const std::size_t named = found.findings.size();
  const std::size_t unnamed = found.unnamed.size();
  std::vector<Plot> plots;
  const NoiseLaw noise = add_noise(laser, all, found, plots, context);
  std::vector<float> ranges;
  std::vector<std::uint32_t> blocks;
  for (std::size_t i = 0; i < all.beams.size(); ++i) {
    if (all.beams.laser[i] != laser) continue;
    ranges.push_back(all.beams.range[i]);
    blocks.push_back(all.blocks[i]);
  }
  if (const auto comb = quantisation(name, ranges, blocks, context.seed())) {
    found.findings.push_back(*comb);
    plots.push_back(comb_plot(name, ranges, comb->parameters.front().value));
  }
  const Crossings edges = crossings_of(laser, all.beams, all.points, all.met, all.crowd, all.usual, noise);
  if (!edges.mixed.empty()) {
    context.say(fmt::format("{}: {} edges crossed, {:.1f} % of them with a range that ends in thin air", name,
                            edges.mixed.size(), 100 * edges.share()));
  }
  if (const auto mixed = mixed_pixels(name, edges, context.seed())) {
    found.findings.push_back(*mixed);
    plots.push_back(edge_plot(name, edges));
  }
  share_explained(std::span(found.findings).subspan(named), std::span(found.unnamed).subspan(unnamed));
  if (folder_ && !plots.empty()) write_plots(*folder_ / (name + "_noise.svg"), plots, context);
  return edges.mixed.size();
}

std::pair<RangeErrors, NoiseDiagnosis> DiagnoseScatterStage::noise_of(std::size_t laser, const Followed& all,
                                                                      Context& context) const {
  constexpr double kMuchLarger = 1.1;
  const std::string& name = calibration_->lasers[laser].name;
  const auto law_of = [&](RangeErrors errors) {
    NoiseDiagnosis law;
    if (errors.size() >= kTooFew) law = diagnose_noise(name, errors, context.seed(), least_gain_);
    return std::pair(std::move(errors), std::move(law));
  };
  auto found = law_of(scatter_of(laser, all.beams, all.met, all.usual, all.blocks));
  const auto& [errors, noise] = found;
  if (errors.size() < kTooFew) return found;
  const double widest = widest_deviation(noise.law, errors);
  if (!(widest > kMuchLarger * noise_)) return found;
  const Evidence wider = all_of(all.model, all.evidence.sample(), widest);
  const Met met = met_by(wider.surfels(), wider.beams(), all.beams.range);
  auto again = law_of(scatter_of(laser, all.beams, met, usual_error(met), all.blocks));
  return again.first.size() < kTooFew ? found : again;
}

NoiseLaw DiagnoseScatterStage::add_noise(std::size_t laser, const Followed& all, Findings& found,
                                         std::vector<Plot>& plots, Context& context) {
  const std::string& name = calibration_->lasers[laser].name;
  const auto [errors, noise] = noise_of(laser, all, context);
  if (errors.size() < kTooFew) {
    context.say(
        fmt::format("{}: too few beams well inside flat surfaces to say how its ranges scatter", name));
    return {.size = {all.usual}};
  }
  context.say(fmt::format("{}: {} ranges on flat surfaces scatter by {:.2f} mm (RMS)", name, errors.size(),
                          1e3 * noise.plain.sigma()));
  found.noise.push_back({.laser = name, .ranges = errors.size(), .sigma = noise.law.sigma()});
  found.findings.insert(found.findings.end(), noise.findings.begin(), noise.findings.end());
  found.unnamed.insert(found.unnamed.end(), noise.unnamed.begin(), noise.unnamed.end());
  for (const auto& [covariate, values] :
       {std::pair("incidence", &errors.cosine), std::pair("remission", &errors.remission)}) {
    const auto changes = noise_by(covariate, *values, name, errors, noise.law, least_gain_, context.seed());
    if (changes) found.unnamed.push_back(*changes);
  }
  plots = noise_plots(name, errors, noise);
  told_.push_back(told_apart(name, errors, noise.law, {}, BeamsOf::kSurfaces, context.seed()));
  return noise.law;
}

}  // namespace crisp
