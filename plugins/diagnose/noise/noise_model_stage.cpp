// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/noise/noise_model_stage.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <limits>
#include <span>
#include <utility>

#include <crisp/registrar.hpp>

#include "pipeline/estimate/free_parameters.hpp"
#include "pipeline/estimate/shared_errors.hpp"
#include "pipeline/plot/write_plot.hpp"
#include "plugins/diagnose/model/surface_observations.hpp"
#include "plugins/diagnose/noise/likelihood_gain.hpp"
#include "plugins/diagnose/noise/noise_diagnosis.hpp"
#include "plugins/diagnose/noise/noise_plots.hpp"
#include "plugins/diagnose/noise/range_quantization.hpp"
#include "plugins/diagnose/noise/surface_range_errors.hpp"
#include "plugins/diagnose/report/findings_report.hpp"
#include "plugins/diagnose/scene/mixed_pixels.hpp"
#include "plugins/diagnose/scene/visibility.hpp"

namespace crisp::diagnose {
namespace {

constexpr std::size_t kTooFew = 1000;  // minimum number of ranges for a noise model

/// @param noise  [m] flatness of the selected surfaces
SurfaceObservations all_of(const SensorModel& model, const estimate::Sample& sample, double noise) {
  estimate::RefinementSettings settings;
  settings.surfels.noise = noise;
  return {model, sample, settings, std::numeric_limits<std::size_t>::max(), {}, SurfacesOf::kSearch};
}

}  // namespace

void DiagnoseNoiseModelStage::describe(StageDescription<DiagnoseNoiseModelStage>& d) {
  d.name("diagnose.noise_model")
      .summary("estimates the range noise of a turning scanner and detects moving objects");
  d.details(
      "Associates each beam with the flat surface that it should meet, by an accurate calibration: put this stage after diagnose.model. The range errors of each laser are compared with the plain simulator's normal noise. Components are noise that grows with range, incidence or weak echoes, heavy tails, two peaks, quantization (`noise.*`), and other dependence on incidence or remission (`unnamed`). BIC selects them, and held-out parts of the recording confirm them. At edges the stage detects ranges between foreground and background (`noise.mixed_pixels`). It compares the ranges in the same directions from turn to turn (`scene.moving`). A goodness-of-fit test compares the ranges of all lasers with simulated ones.");
  d.takes<Measurements>()
      .takes<Findings>(Need::optional)
      .holds<PlateTrajectory>()
      .holds<Calibration>()
      .gives<Findings>();
  d.option("noise", &DiagnoseNoiseModelStage::noise_,
           "approximate standard deviation of ranges, used to select flat surfaces")
      .unit("m")
      .range(1e-6, 1);
  d.option(
       "min_gain", &DiagnoseNoiseModelStage::least_gain_,
       "minimum gain of a noise component in log-likelihood per held-out range; smaller gains may come from the roughness of surfaces")
      .unit("nat")
      .range(0, 10);
  d.option("folder", &DiagnoseNoiseModelStage::folder_,
           "folder for plots of each laser's noise and of moving objects; auto: no plots")
      .writes_into({"*_noise.svg", "scene_moving.svg"});
}

void DiagnoseNoiseModelStage::process(const Inputs& in, Outputs&, Context& context) {
  if (const Findings* before = in.find<Findings>()) all_.append(*before);
  if (!in.find<Measurements>()) return;
  calibration_ = in.share<Calibration>();
  collected_.add(in.share<Measurements>(),
                 oriented_(in.share<PlateTrajectory>(), calibration_.get(), context.rig()));
}

void DiagnoseNoiseModelStage::finish(Outputs& out, Context& context) {
  const estimate::Sample sample = estimate::longest_recording(collected_.sample());
  context.count("beams left out of the diagnosis of a long recording", collected_.left_out());
  const SensorModel model(*calibration_, context.run().registrar->get<TermRegistry>());
  const estimate::LagRange lag = estimate::lag_range(model, 0);
  context.progress(0, "associating beams with surfaces");
  const SurfaceObservations observations =
      all_of(model, estimate::placeable(model, estimate::covered(sample, lag.earliest, lag.latest)), noise_);
  const Measurements& beams = observations.sample().beams;
  AssociatedBeams all{
      .model = model,
      .observations = observations,
      .beams = beams,
      .points = observations.beams().points,
      .association = associate_beams(observations.surfels(), observations.beams(), beams.range),
      .density = PointDensity(observations.beams().points),
      .blocks = estimate::recording_blocks(beams)};
  all.typical_sigma = usual_error(all.association);
  Findings found;
  std::vector<std::string> without_edges;
  for (std::size_t laser = 0; laser < model.lasers(); ++laser) {
    context.progress(static_cast<double>(laser) / static_cast<double>(model.lasers()), "fitting noise");
    if (context.interrupted()) return;
    if (add_laser(laser, all, found, context) == 0) without_edges.push_back(calibration_->lasers[laser].name);
  }
  if (!without_edges.empty()) {
    context.print(fmt::format("mixed pixels not tested: no edges were crossed by {}",
                              without_edges.size() == model.lasers()
                                  ? std::string("any laser")
                                  : fmt::format("{}", fmt::join(without_edges, ", "))));
  }
  const auto changing =
      changing_directions(beams, *observations.sample().plate, all.association, all.typical_sigma);
  if (const auto moved = moving(changing, context.seed())) {
    found.findings.push_back(*moved);
    if (folder_) plot::write_plots(*folder_ / "scene_moving.svg", {moving_plot(changing)}, context);
  }
  data::add_fit_statistics(reported_, found);
  for (const Finding& finding : found.findings) context.print(in_words(finding));
  for (const UnnamedFinding& finding : found.unnamed) context.print(in_words(finding));
  if (!reported_.empty()) context.print(data::fit_statistics_text(found));
  context.report({{"findings", found.findings.size()},
                  {"unnamed", found.unnamed.size()},
                  {"before_p", found.before_p},
                  {"after_p", found.after_p}});
  all_.append(found);
  out.give(std::move(all_));
}

std::size_t DiagnoseNoiseModelStage::add_laser(std::size_t laser, const AssociatedBeams& all, Findings& found,
                                               Context& context) {
  const std::string& name = calibration_->lasers[laser].name;
  const std::size_t named = found.findings.size();
  const std::size_t unnamed = found.unnamed.size();
  std::vector<plot::Plot> plots;
  const NoiseModel noise = add_noise(laser, all, found, plots, context);
  std::vector<float> ranges;
  std::vector<std::uint32_t> blocks;
  for (std::size_t i = 0; i < all.beams.size(); ++i) {
    if (all.beams.laser[i] != laser) continue;
    ranges.push_back(all.beams.range[i]);
    blocks.push_back(all.blocks[i]);
  }
  if (const auto quantization = range_quantization(name, ranges, blocks, context.seed())) {
    found.findings.push_back(*quantization);
    plots.push_back(quantization_plot(name, ranges, quantization->parameters.front().value));
  }
  const Crossings edges =
      crossings_of(laser, all.beams, all.points, all.association, all.density, all.typical_sigma, noise);
  if (!edges.mixed.empty()) {
    context.print(fmt::format("{}: {} edges crossed, {:.1f} % of them with a mixed pixel", name,
                              edges.mixed.size(), 100 * edges.share()));
  }
  if (const auto mixed = mixed_pixels(name, edges)) {
    found.findings.push_back(*mixed);
    plots.push_back(edge_plot(name, edges));
  }
  share_explained(std::span(found.findings).subspan(named), std::span(found.unnamed).subspan(unnamed));
  if (folder_ && !plots.empty()) plot::write_plots(*folder_ / (name + "_noise.svg"), plots, context);
  return edges.mixed.size();
}

std::pair<RangeErrors, NoiseDiagnosis> DiagnoseNoiseModelStage::noise_of(std::size_t laser,
                                                                         const AssociatedBeams& all,
                                                                         Context& context) const {
  constexpr double kMuchLarger = 1.1;
  const std::string& name = calibration_->lasers[laser].name;
  const auto model_of = [&](RangeErrors errors) {
    NoiseDiagnosis model;
    if (errors.size() >= kTooFew) model = diagnose_noise(name, errors, context.seed(), least_gain_);
    return std::pair(std::move(errors), std::move(model));
  };
  auto found = model_of(scatter_of(laser, all.beams, all.association, all.typical_sigma, all.blocks));
  const auto& [errors, noise] = found;
  if (errors.size() < kTooFew) return found;
  const double widest = widest_deviation(noise.model, errors);
  if (!(widest > kMuchLarger * noise_)) return found;
  const SurfaceObservations wider = all_of(all.model, all.observations.sample(), widest);
  const BeamAssociation association = associate_beams(wider.surfels(), wider.beams(), all.beams.range);
  auto again = model_of(scatter_of(laser, all.beams, association, usual_error(association), all.blocks));
  return again.first.size() < kTooFew ? found : again;
}

NoiseModel DiagnoseNoiseModelStage::add_noise(std::size_t laser, const AssociatedBeams& all, Findings& found,
                                              std::vector<plot::Plot>& plots, Context& context) {
  const std::string& name = calibration_->lasers[laser].name;
  const auto [errors, noise] = noise_of(laser, all, context);
  if (errors.size() < kTooFew) {
    context.print(
        fmt::format("{}: noise not estimated, since too few beams lie well inside flat surfaces", name));
    return {.size = {all.typical_sigma}};
  }
  context.print(fmt::format("{}: {} ranges on flat surfaces have noise of {:.2f} mm (RMS)", name,
                            errors.size(), 1e3 * noise.plain.sigma()));
  found.noise.push_back({.laser = name, .ranges = errors.size(), .sigma = noise.model.sigma()});
  found.findings.insert(found.findings.end(), noise.findings.begin(), noise.findings.end());
  found.unnamed.insert(found.unnamed.end(), noise.unnamed.begin(), noise.unnamed.end());
  for (const auto& [covariate, values] :
       {std::pair("incidence", &errors.cosine), std::pair("remission", &errors.remission)}) {
    const auto changes = noise_by(covariate, *values, name, errors, noise.model, least_gain_, context.seed());
    if (changes) found.unnamed.push_back(*changes);
  }
  plots = noise_plots(name, errors, noise);
  reported_.push_back(goodness_of_fit(name, errors, noise.model, {}, BeamsOf::kSurfaces, context.seed()));
  return noise.model;
}

}  // namespace crisp::diagnose
