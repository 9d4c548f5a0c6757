// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/report/residual_plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "pipeline/data/degree.hpp"
#include "pipeline/data/goodness_of_fit_tests.hpp"
#include "pipeline/data/shown_unit.hpp"
#include "plugins/diagnose/report/residual_density_plot.hpp"

namespace crisp::diagnose {
namespace {

/// Display unit of a covariate; ranges stay in metres.
data::ShownUnit unit_of_axis(const std::string& unit) {
  if (unit == "rad") return {.factor = 1 / data::kDegree, .name = "deg"};
  if (unit == "rad/s") return {.factor = 1 / data::kDegree, .name = "deg/s"};
  return {.name = unit};
}

const Profile* find_profile(const ProfileComparison& all, std::size_t laser, const std::string& covariate) {
  const auto found = std::ranges::find_if(all.profiles, [&](const Profile& profile) {
    return profile.laser == laser && profile.covariate == covariate;
  });
  return found == all.profiles.end() ? nullptr : &*found;
}

/// Labels of the bins where the covariate is categorical.
std::vector<plot::PlotKind> kinds_in(const Profile& profile, const std::vector<std::string>& lasers) {
  std::vector<plot::PlotKind> kinds;
  const auto add = [&](const std::string& name) {
    kinds.push_back({.at = static_cast<double>(kinds.size() + 1), .name = name});
  };
  for (const Profile::Bin& bin : profile.bins) {
    if (profile.covariate == "front/back") add(bin.at == 0 ? "front" : "back");
    if (profile.covariate == "laser") add(lasers.at(static_cast<std::size_t>(bin.at) - 1));
  }
  return kinds;
}

void add_profile(const Profile& profile, const std::string& when, plot::Plot& plot) {
  constexpr double kBar = 2;  // standard errors
  constexpr double kBreak = std::numeric_limits<double>::quiet_NaN();
  const double factor = unit_of_axis(profile.unit).factor;
  plot::PlotSeries measured{.name = "measured" + when, .x = {}, .y = {}};
  plot::PlotSeries simulated{.name = "simulated" + when, .x = {}, .y = {}, .joined = false};
  const auto add = [&](double x, const Profile::Bin& bin) {
    measured.x.push_back(x);
    measured.y.push_back(1e3 * bin.measured);
    measured.error.push_back(1e3 * kBar * bin.error);
    simulated.x.push_back(x);
    simulated.y.push_back(1e3 * bin.simulated);
  };
  for (std::size_t b = 0; b < profile.bins.size(); ++b) {
    const Profile::Bin& bin = profile.bins[b];
    if (b > 0 && bin.recording != profile.bins[b - 1].recording) add(kBreak, bin);
    add(b < plot.kinds.size() ? plot.kinds[b].at : bin.at * factor, bin);
  }
  plot.series.push_back(std::move(measured));
  plot.series.push_back(std::move(simulated));
}

std::string size_in_words(const Profile& profile) {
  return fmt::format("{:.2f} mm ({})", 1e3 * profile.rms, data::chance_in_words(profile.p_value));
}

bool is_same(const Profile& one, const Profile& other) {
  return std::ranges::equal(one.bins, other.bins, [](const Profile::Bin& a, const Profile::Bin& b) {
    return a.at == b.at && a.measured == b.measured && a.simulated == b.simulated;
  });
}

plot::Plot profile_plot(const std::string& name, const Profile& before, const Profile* after,
                        const std::vector<std::string>& lasers) {
  const data::ShownUnit unit = unit_of_axis(before.unit);
  plot::Plot plot{
      .title = fmt::format("{} against {}: {}", name, before.covariate, size_in_words(before)),
      .x_label = unit.name.empty() ? before.covariate : fmt::format("{} [{}]", before.covariate, unit.name),
      .y_label = "mean residual [mm]",
      .kinds = kinds_in(before, lasers)};
  if (after && !is_same(before, *after)) {
    plot.title += ", then " + size_in_words(*after);
    add_profile(before, " before", plot);
    add_profile(*after, " after", plot);
  } else {
    add_profile(before, "", plot);
  }
  return plot;
}

const Distribution* find_distribution(const ProfileComparison& all, std::size_t laser) {
  const auto found = std::ranges::find(all.distributions, laser, &Distribution::laser);
  return found == all.distributions.end() ? nullptr : &*found;
}

}  // namespace

std::vector<plot::Plot> residual_plots(std::size_t laser, const std::vector<std::string>& lasers,
                                       const ProfileComparison& before, const ProfileComparison& after) {
  const std::string name = laser == kAllLasers ? "scanner" : lasers.at(laser);
  std::vector<plot::Plot> plots;
  if (const Distribution* own = find_distribution(before, laser))
    plots.push_back(distribution_plot(name, *own, find_distribution(after, laser)));
  for (const Profile& profile : before.profiles) {
    if (profile.laser != laser) continue;
    plots.push_back(profile_plot(name, profile, find_profile(after, laser, profile.covariate), lasers));
  }
  return plots;
}

}  // namespace crisp::diagnose
