// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/flat_surfaces.hpp"

#include <utility>

#include "pipeline/estimate/surface_association.hpp"
#include "pipeline/quality/blocks.hpp"
#include "pipeline/quality/surfel_end_rejection.hpp"
#include "pipeline/quality/surfel_residuals.hpp"
#include "pipeline/quality/wall_segments.hpp"

namespace crisp::estimate {
namespace {

using quality::SurfelSettings;

class Patches final : public FlatSurfaces {
 public:
  Patches(const SurfelSettings& settings, int searches, bool swept, quality::Surfels known)
      : settings_(settings),
        searches_(searches),
        swept_(swept),
        surfels_(std::move(known)),
        known_beams_(swept ? surfels_.members.size() : 0) {}

  const quality::Surfels& update(const quality::BeamsView& beams, bool is_moving) override {
    if (!is_searching_) {
      if (swept_) quality::refit_all(surfels_, beams, settings_);
      return surfels_;
    }
    is_searching_ = is_moving && round_++ < searches_;
    if (!is_searching_) {
      complete(beams);
      is_searching_ = has_outgrown_known();
      known_beams_ = 0;
    } else if (known_beams_ > 0) {
      quality::refine_all(surfels_, beams, settings_);
    } else {
      find(beams, settings_);
    }
    return surfels_;
  }

  bool is_settled() const override { return !is_searching_; }

 private:
  /// Whether the known surfaces were those of a model too far off to begin with.
  bool has_outgrown_known() const {
    constexpr double kMany = 1.05;
    return known_beams_ > 0 &&
           static_cast<double>(surfels_.members.size()) > kMany * static_cast<double>(known_beams_);
  }

  void find(const quality::BeamsView& beams, const SurfelSettings& settings) {
    // Cells along edges belong to no surface of their own, but their beams carry much information.
    surfels_ = associate_with_surfaces(quality::find_surfels(beams, settings), beams, settings,
                                       {.margin = settings.smallest});
    quality::refine_all(surfels_, beams, settings);
  }

  /// Settles which pieces are of one surface, how far surfaces go and which of them count. Not earlier: as
  /// long as parameters are off, walls are bent, and views disagree, most on what is far away.
  void complete(const quality::BeamsView& beams) {
    constexpr double kBump = 0.5;
    constexpr double kSpacings = 4;
    constexpr double kMore = 1.3;
    SurfelSettings strict = settings_;
    if (swept_) strict.max_bump = kBump;
    if (swept_ || surfels_.surfels.empty()) find(beams, strict);
    surfels_ =
        grow_surfaces(surfels_, beams, settings_, {.margin = settings_.smallest, .spacings = kSpacings});
    quality::refine_all(surfels_, beams, settings_);
    quality::for_each_index(surfels_.surfels.size(), [&](std::size_t s) {
      quality::cut_strange_ends(surfels_.surfels[s], surfels_, beams, settings_);
    });
    quality::reject_inconsistent(surfels_, beams, settings_, kMore);
    if (swept_) quality::reject_grazed(surfels_, beams);
  }

  SurfelSettings settings_;
  int searches_;
  bool swept_;
  quality::Surfels surfels_;
  std::size_t known_beams_;  // on surfaces that were known before; 0: none were, or they no longer count
  int round_ = 0;
  bool is_searching_ = true;
};

class UprightWalls final : public FlatSurfaces {
 public:
  UprightWalls(const SurfelSettings& settings, int searches) : settings_(settings), searches_(searches) {}

  const quality::Surfels& update(const quality::BeamsView& beams, bool is_moving) override {
    if (!is_searching_) return walls_;
    is_searching_ = widening_ > 1 || (is_moving && round_++ < searches_);
    if (is_searching_) {
      walls_ = quality::wall_lines(beams, {.noise = widening_ * settings_.noise});
      widening_ = std::max(1.0, widening_ / 2);
    }
    quality::refine_all(walls_, beams, settings_);
    return walls_;
  }

  bool is_settled() const override { return !is_searching_; }

 private:
  SurfelSettings settings_;
  int searches_;
  quality::Surfels walls_;
  double widening_ = 8;  // of the noise, for what views disagree by; halved from one round to the next
  int round_ = 0;
  bool is_searching_ = true;
};

}  // namespace

std::unique_ptr<FlatSurfaces> patches(const SurfelSettings& settings, int searches, bool swept,
                                      quality::Surfels known) {
  return std::make_unique<Patches>(settings, searches, swept, std::move(known));
}

std::unique_ptr<FlatSurfaces> upright_walls(const SurfelSettings& settings, int searches) {
  return std::make_unique<UprightWalls>(settings, searches);
}

}  // namespace crisp::estimate
