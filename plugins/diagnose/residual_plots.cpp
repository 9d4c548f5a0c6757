// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/residual_plots.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "pipeline/data/degree.hpp"
#include "pipeline/data/likeness.hpp"

namespace crisp {
namespace {

/// A unit as people read it.
struct ShownUnit {
  std::string name;
  double factor = 1;
};

ShownUnit shown_unit(const std::string& unit) {
  if (unit == "rad") return {.name = "deg", .factor = 1 / kDegree};
  if (unit == "rad/s") return {.name = "deg/s", .factor = 1 / kDegree};
  return {.name = unit};
}

const Profile* find_profile(const SideBySide& all, std::size_t laser, const std::string& covariate) {
  const auto found = std::ranges::find_if(all.profiles, [&](const Profile& profile) {
    return profile.laser == laser && profile.covariate == covariate;
  });
  return found == all.profiles.end() ? nullptr : &*found;
}

void add_profile(const Profile& profile, const std::string& when, Plot& plot) {
  constexpr double kBar = 2;  // standard errors
  const double factor = shown_unit(profile.unit).factor;
  PlotSeries measured{.name = "measured" + when, .x = {}, .y = {}};
  PlotSeries simulated{.name = "simulated" + when, .x = {}, .y = {}, .joined = false};
  for (const Profile::Bin& bin : profile.bins) {
    measured.x.push_back(bin.at * factor);
    measured.y.push_back(1e3 * bin.measured);
    measured.error.push_back(1e3 * kBar * bin.error);
    simulated.x.push_back(bin.at * factor);
    simulated.y.push_back(1e3 * bin.simulated);
  }
  plot.series.push_back(std::move(measured));
  plot.series.push_back(std::move(simulated));
}

std::string size_in_words(const Profile& profile) {
  return fmt::format("{:.2f} mm ({})", 1e3 * profile.rms, chance_in_words(profile.p_value));
}

bool is_same(const Profile& one, const Profile& other) {
  return std::ranges::equal(one.bins, other.bins, [](const Profile::Bin& a, const Profile::Bin& b) {
    return a.at == b.at && a.measured == b.measured && a.simulated == b.simulated;
  });
}

}  // namespace

std::vector<Plot> residual_plots(std::size_t laser, const std::string& name, const SideBySide& before,
                                 const SideBySide& after) {
  std::vector<Plot> plots;
  for (const Profile& profile : before.profiles) {
    if (profile.laser != laser) continue;
    const ShownUnit unit = shown_unit(profile.unit);
    Plot plot{.title = fmt::format("{} against {}: {}", name, profile.covariate, size_in_words(profile)),
              .x_label = unit.name.empty() ? profile.covariate
                                           : fmt::format("{} [{}]", profile.covariate, unit.name),
              .y_label = "mean residual [mm]",
              .series = {}};
    const Profile* extended = find_profile(after, laser, profile.covariate);
    if (extended && !is_same(profile, *extended)) {
      plot.title += ", then " + size_in_words(*extended);
      add_profile(profile, " before", plot);
      add_profile(*extended, " after", plot);
    } else {
      add_profile(profile, "", plot);
    }
    plots.push_back(std::move(plot));
  }
  return plots;
}

}  // namespace crisp
