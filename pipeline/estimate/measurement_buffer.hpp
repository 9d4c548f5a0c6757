// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "pipeline/estimate/sample.hpp"

namespace crisp::estimate {

/// Buffers the measurements that flow through a stage. For long recordings it keeps half of the batches
/// (scans), then a quarter, and so on, so that memory is bounded.
class MeasurementBuffer {
 public:
  explicit MeasurementBuffer(std::size_t most_beams = 8'000'000) : most_(most_beams) {}

  /// Adds one batch (a scan, for example) and the plate's motion during it.
  void add(std::shared_ptr<const Measurements> beams, std::shared_ptr<const PlateTrajectory> plate);

  /// @throws Error  if nothing came
  /// @return  all kept beams, over the joined trajectory; to be used while this lives
  Sample sample();

  std::size_t left_out() const { return left_out_; }  ///< beams of the batches that were not kept

 private:
  struct Batch {
    std::shared_ptr<const Measurements> beams;
    double lot = 0;
  };
  void drop_down_to(double share);

  std::size_t most_;
  double share_ = 1;  // of the batches that are kept: those whose lot is below
  std::size_t batches_ = 0;
  std::size_t beams_ = 0;
  std::size_t left_out_ = 0;
  std::vector<Batch> kept_;
  std::vector<std::shared_ptr<const PlateTrajectory>> pieces_;
  PlateTrajectory plate_;
};

}  // namespace crisp::estimate
