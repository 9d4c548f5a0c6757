// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include <crisp/sensor_model.hpp>

#include "pipeline/model/chain_jacobian.hpp"

namespace crisp::model {

/// A term that a model does not have, at neutral values, which change no beam.
struct AddedTerm {
  std::shared_ptr<const ModelTerm> term;
  std::vector<double> values;           ///< of all its parameters
  std::vector<std::size_t> parameters;  ///< those with respect to which is differentiated
  std::vector<std::size_t> columns;     ///< of the Jacobian, one for each of `parameters`
};

/// Derivatives of beams' ends with respect to parameters of terms that a model does not have. They equal
/// those of a model with these terms.
class AddedTerms {
 public:
  /// @param of_laser  for each laser of the model, its own terms and the plate's; none for those beyond its
  /// end
  AddedTerms(SensorModel model, const std::vector<std::vector<AddedTerm>>& of_laser);

  /// Sets rows[row of the beam · stride + column] to normal · ∂x/∂parameter [m] for beams that the encoder
  /// readings cover. Thread-safe.
  ///
  /// @param normal  in the base's frame
  void fill_rows(const Measurements& beams, const PlateTrajectory& plate, const Eigen::Vector3d& normal,
                 std::size_t stride, std::span<double> rows) const;

 private:
  SensorModel model_;  // whose chains of_laser_ refers to
  std::vector<ChainJacobian<1>> of_laser_;
};

}  // namespace crisp::model
