// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "pipeline/data/findings.hpp"
#include "pipeline/data/oriented_plate.hpp"
#include "pipeline/estimate/collected.hpp"
#include "pipeline/plot/plot.hpp"
#include "pipeline/quality/surfels.hpp"
#include "pipeline/stage/context.hpp"
#include "pipeline/stage/description.hpp"
#include "plugins/diagnose/edges.hpp"
#include "plugins/diagnose/evidence.hpp"
#include "plugins/diagnose/met.hpp"
#include "plugins/diagnose/noise.hpp"
#include "plugins/diagnose/noise_law.hpp"
#include "plugins/diagnose/told_apart.hpp"

namespace crisp {

/// Says how the ranges of a turning scanner scatter, and what moved (stage `diagnose.scatter`).
class DiagnoseScatterStage final : public Stage {
 public:
  static void describe(StageDescription<DiagnoseScatterStage>& d);
  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  /// All beams, and what became of them.
  struct Followed {
    const SensorModel& model;
    const Evidence& evidence;
    const Measurements& beams;
    PointsView points;
    Met met;
    Crowd crowd;
    double usual = 0;  // [m] standard deviation of ranges
    std::vector<std::uint32_t> blocks;
  };
  /// @return how many edges it crossed
  std::size_t add_laser(std::size_t laser, const Followed& all, Findings& found, Context& context);
  /// The errors of one laser's ranges, and the law that they show. Surfaces are those that are flat within
  /// `noise`: where the laser's own is larger, these would be places where it is small by chance, and they
  /// are looked for again, flat within its own.
  std::pair<RangeErrors, NoiseDiagnosis> noise_of(std::size_t laser, const Followed& all,
                                                  Context& context) const;
  /// @param plots  get what is drawn of what was found
  NoiseLaw add_noise(std::size_t laser, const Followed& all, Findings& found, std::vector<Plot>& plots,
                     Context& context);

  double noise_ = SurfelSettings{}.noise;
  double least_gain_ = 0.001;
  std::optional<std::filesystem::path> folder_;
  OrientedPlate oriented_;
  Collected collected_;
  std::shared_ptr<const Calibration> calibration_;
  std::vector<ToldApart> told_;
  Findings all_;  // what other diagnoses said before
};

}  // namespace crisp
