// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/flat_surfaces.hpp"

#include "pipeline/estimate/claims.hpp"
#include "pipeline/quality/blocks.hpp"
#include "pipeline/quality/surfel_ends.hpp"
#include "pipeline/quality/surfel_residuals.hpp"

namespace crisp {
namespace {

void refine_all(Surfels& surfels, const BeamsView& beams, const SurfelSettings& settings) {
  for_each_index(surfels.surfels.size(),
                 [&](std::size_t s) { refine(surfels.surfels[s], surfels, beams, settings); });
}

class Patches final : public FlatSurfaces {
 public:
  explicit Patches(const SurfelSettings& settings) : settings_(settings) {}

  const Surfels& update(const BeamsView& beams, double last_step) override {
    if (!is_searching_) return surfels_;
    // Beams that join and leave surfaces at their rims would keep the steps from getting any smaller.
    constexpr double kSmallStep = 0.5;
    // From a degree off, walls that lie apart come together one after the other.
    constexpr int kSearches = 12;
    is_searching_ = last_step > kSmallStep && round_++ < kSearches;
    if (is_searching_) {
      // Cells along edges are no surfaces' own, but what was met there tells much.
      surfels_ = find_surfels(beams, settings_);
      surfels_ = claimed(surfels_, beams, settings_, {.margin = settings_.smallest});
      refine_all(surfels_, beams, settings_);
    } else {
      complete(beams);
    }
    return surfels_;
  }

  bool is_settled() const override { return !is_searching_; }

 private:
  /// Settles how far surfaces go and which of them count. Not earlier: as long as parameters are off, views
  /// disagree, and most on what is far away.
  void complete(const BeamsView& beams) {
    constexpr double kSpacings = 4;
    constexpr double kMore = 1.3;
    surfels_ = grown(surfels_, beams, settings_, {.margin = settings_.smallest, .spacings = kSpacings});
    refine_all(surfels_, beams, settings_);
    for_each_index(surfels_.surfels.size(),
                   [&](std::size_t s) { cut_strange_ends(surfels_.surfels[s], surfels_, beams, settings_); });
    leave_out_odd_ones(surfels_, beams, settings_, kMore);
  }

  SurfelSettings settings_;
  Surfels surfels_;
  int round_ = 0;
  bool is_searching_ = true;
};

class UprightWalls final : public FlatSurfaces {
 public:
  explicit UprightWalls(const SurfelSettings& settings) : settings_(settings) {}

  const Surfels& update(const BeamsView& beams, double) override {
    constexpr int kSearches = 2;
    if (round_ < kSearches) walls_ = find_surfels(beams, settings_);
    if (round_ < kRenewals) walls_ = claimed(walls_, beams, settings_);
    // Weights that come and go by a hair would keep the steps from getting any smaller.
    constexpr int kWeighings = 9;
    if (round_ < kWeighings) refine_all(walls_, beams, settings_);
    ++round_;
    return walls_;
  }

  bool is_settled() const override { return round_ > kRenewals; }

 private:
  static constexpr int kRenewals = 5;  // rounds in which it is decided anew which wall each beam met

  SurfelSettings settings_;
  Surfels walls_;
  int round_ = 0;
};

}  // namespace

std::unique_ptr<FlatSurfaces> patches(const SurfelSettings& settings) {
  return std::make_unique<Patches>(settings);
}

std::unique_ptr<FlatSurfaces> upright_walls(const SurfelSettings& settings) {
  return std::make_unique<UprightWalls>(settings);
}

}  // namespace crisp
