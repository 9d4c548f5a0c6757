// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <crisp/context.hpp>
#include <crisp/findings.hpp>
#include <crisp/stage.hpp>

#include "pipeline/data/oriented_plate.hpp"
#include "pipeline/estimate/measurement_buffer.hpp"
#include "pipeline/plot/plot.hpp"
#include "pipeline/quality/surfels.hpp"
#include "plugins/diagnose/model/surface_observations.hpp"
#include "plugins/diagnose/noise/goodness_of_fit.hpp"
#include "plugins/diagnose/noise/noise_diagnosis.hpp"
#include "plugins/diagnose/noise/noise_model.hpp"
#include "plugins/diagnose/scene/beam_association.hpp"
#include "plugins/diagnose/scene/mixed_pixels.hpp"

namespace crisp::diagnose {

/// Stage `diagnose.noise_model`: estimates the range noise of a turning scanner and detects moving objects.
class DiagnoseNoiseModelStage final : public Stage {
 public:
  static void describe(StageDescription<DiagnoseNoiseModelStage>& d);
  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  /// All beams with their associated surfaces.
  struct AssociatedBeams {
    const SensorModel& model;
    const SurfaceObservations& observations;
    const Measurements& beams;
    PointsView points;
    BeamAssociation association;
    PointDensity density;
    double typical_sigma = 0;  // [m] standard deviation of ranges
    std::vector<std::uint32_t> blocks;
  };
  /// @return number of edges that the laser crossed
  std::size_t add_laser(std::size_t laser, const AssociatedBeams& all, Findings& found, Context& context);
  /// Range errors and noise model of one laser. Surfaces are selected as flat within `noise`. If the laser's
  /// noise is larger, that selection favours places of small errors, so the surfaces are selected again with
  /// its own.
  std::pair<RangeErrors, NoiseDiagnosis> noise_of(std::size_t laser, const AssociatedBeams& all,
                                                  Context& context) const;
  /// @param plots  receives the plots of the noise model
  NoiseModel add_noise(std::size_t laser, const AssociatedBeams& all, Findings& found,
                       std::vector<plot::Plot>& plots, Context& context);

  double noise_ = quality::SurfelSettings{}.noise;
  double least_gain_ = 0.001;
  std::optional<std::filesystem::path> folder_;
  data::OrientedPlate oriented_;
  estimate::MeasurementBuffer collected_;
  std::shared_ptr<const Calibration> calibration_;
  std::vector<data::GoodnessOfFit> reported_;
  Findings all_;  // including those of earlier stages
};

}  // namespace crisp::diagnose
