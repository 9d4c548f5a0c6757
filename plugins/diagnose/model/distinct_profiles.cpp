// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/distinct_profiles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include "pipeline/statistics/multiple_testing.hpp"
#include "plugins/diagnose/model/mean_residuals.hpp"

namespace crisp::diagnose {
namespace {

/// Profiles that are selected together: one, or all lasers' over a covariate that lasers share.
using ProfileGroup = std::vector<std::size_t>;

bool is_shared_by_lasers(const std::string& covariate) {
  constexpr std::array kOfThePlate = {"plate angle", "plate rate", "time"};
  return std::ranges::find(kOfThePlate, covariate) != kOfThePlate.end();
}

std::vector<ProfileGroup> profile_groups(const std::vector<Profile>& profiles) {
  std::vector<ProfileGroup> groups;
  std::map<std::string, ProfileGroup> shared;
  std::map<std::string, std::size_t> lasers;
  for (std::size_t p = 0; p < profiles.size(); ++p) {
    if (profiles[p].laser == kAllLasers) continue;
    ++lasers[profiles[p].covariate];
    if (!profiles[p].is_significant()) continue;
    groups.push_back({p});
    if (is_shared_by_lasers(profiles[p].covariate)) shared[profiles[p].covariate].push_back(p);
  }
  for (const auto& [covariate, group] : shared) {
    if (group.size() > 1 && group.size() == lasers[covariate]) groups.push_back(group);
  }
  return groups;
}

std::vector<double> standard_errors(const Profile& profile) {
  std::vector<double> errors;
  for (const Profile::Bin& bin : profile.bins) errors.push_back(bin.error);
  return errors;
}

void subtract(const QuantileBins& layout, const std::vector<double>& means, WeightedResiduals& residuals) {
  for (std::size_t b = 0; b < means.size(); ++b) {
    for (std::size_t k = layout.first[b]; k < layout.first[b + 1]; ++k)
      residuals.value[layout.residual[k]] -= means[b];
  }
}

/// What remains of a profile while others are subtracted.
struct Remaining {
  std::vector<double> means;
  double rms = 0;           ///< [m]
  bool is_distinct = true;  ///< neither selected yet nor a shadow
};

class ShadowSearch {
 public:
  ShadowSearch(std::vector<Profile>& profiles, const std::vector<QuantileBins>& layouts,
               WeightedResiduals residuals, double tests)
      : profiles_(profiles),
        layouts_(layouts),
        residuals_(std::move(residuals)),
        tests_(tests),
        remaining_(profiles.size()),
        groups_(profile_groups(profiles)) {
    for (std::size_t p = 0; p < profiles.size(); ++p)
      remaining_[p] = {.means = means_in(layouts[p], residuals_), .rms = profiles[p].rms};
  }

  void run() {
    while (!groups_.empty()) {
      const ProfileGroup most = *std::ranges::max_element(
          groups_, {}, [this](const ProfileGroup& group) { return square_of(group); });
      for (const std::size_t p : most) {
        profiles_[p].is_common = most.size() > 1;
        subtract(layouts_[p], remaining_[p].means, residuals_);
        remaining_[p].is_distinct = false;
      }
      drop_closed_groups();
      for (const ProfileGroup& group : groups_) {
        if (group.size() == 1) test_again(group.front());
      }
      drop_closed_groups();
    }
  }

 private:
  /// [m²] Mean square over all residuals that the group explains.
  double square_of(const ProfileGroup& group) const {
    double square = 0;
    for (const std::size_t p : group) square += profiles_[p].share * std::pow(remaining_[p].rms, 2);
    return square;
  }

  void test_again(std::size_t p) {
    const auto errors = standard_errors(profiles_[p]);
    Remaining& own = remaining_[p];
    own.means = means_in(layouts_[p], residuals_);
    own.rms = systematic_rms(own.means, errors);
    Profile left = profiles_[p];
    left.p_value = statistics::sidak_p_value(tests_, profile_p_value(layouts_[p], own.means, errors));
    constexpr double kHalf = 0.5;
    if (left.is_significant() && own.rms >= kHalf * profiles_[p].rms) return;
    profiles_[p].is_shadow = true;
    own.is_distinct = false;
  }

  void drop_closed_groups() {
    std::erase_if(groups_, [this](const ProfileGroup& group) {
      return std::ranges::any_of(group, [this](std::size_t p) { return !remaining_[p].is_distinct; });
    });
  }

  std::vector<Profile>& profiles_;
  const std::vector<QuantileBins>& layouts_;
  WeightedResiduals residuals_;
  double tests_;
  std::vector<Remaining> remaining_;  // by profile
  std::vector<ProfileGroup> groups_;
};

}  // namespace

void mark_shadows(std::vector<Profile>& profiles, const std::vector<QuantileBins>& layouts,
                  const WeightedResiduals& residuals, double tests) {
  ShadowSearch(profiles, layouts, residuals, tests).run();
}

}  // namespace crisp::diagnose
