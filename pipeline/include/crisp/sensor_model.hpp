// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <crisp/calibration.hpp>
#include <crisp/measurements.hpp>
#include <crisp/plate_trajectory.hpp>
#include <crisp/term.hpp>

namespace crisp {

/// The terms of a calibration, resolved once: `slots` are their parameters' positions in a laser's list.
struct ChainTerm {
  std::shared_ptr<const ModelTerm> term;  ///< that changes the beams
  std::size_t first_slot = 0;             ///< its first parameter's index in LaserChain::slots
};

/// The chain of one laser: which of the model's parameters it depends on, and its terms by phase.
struct LaserChain {
  std::vector<std::size_t> slots;  ///< index in SensorModel::values(): λ, τ, α, η, own terms, the plate's
  std::vector<std::vector<ChainTerm>> phases;  ///< by Phase
  bool bare = true;                            ///< equation (2) alone: no terms
};

namespace simd {
struct BareLaser;
struct MirrorTable;
}  // namespace simd

/// Sines and cosines of mirror angles, kept from scan to scan: a laser's angles are mostly the same in each.
/// For a caller who places scan after scan; not from several threads at once.
class MirrorAngleCache {
 public:
  /// The cached values of a laser, with room for the beams numbered below `beams`. Valid until the next call.
  simd::MirrorTable of(std::size_t laser, std::size_t beams);

 private:
  struct Table {
    std::vector<float> angle;
    std::vector<double> sine;
    std::vector<double> cosine;
  };
  std::vector<Table> tables_;  // by laser
};

/// Points with their measurements.
struct Placed {
  Eigen::Matrix3Xd points;           ///< [m] in the base's frame, one a column
  std::vector<std::uint32_t> index;  ///< the measurement of each; those that the encoder readings do not
                                     ///< cover are left out
};

/// Placed measurements that follow one another.
struct PlacedRun {
  std::size_t first;          ///< index of the measurement that the first point is of
  std::span<const double> x;  ///< [m] in the base's frame, as are y and z
  std::span<const double> y;  ///< [m]
  std::span<const double> z;  ///< [m]
};
using TakePlaced = std::function<void(const PlacedRun&)>;

/// d(point)/d(parameter) of placed points.
struct PointDerivatives {
  std::vector<std::vector<std::size_t>> columns;  ///< by laser: the free parameters it depends on, as indices
                                                  ///< into the list of free ones
  std::size_t stride = 0;                         ///< columns of the laser with the most
  Eigen::Matrix3Xd values;  ///< 3 × (stride · points): column k of point i is at i · stride + k
};

/// Equations (1) to (3) of Sheehan, Harrison and Newman, and whatever terms a calibration adds to them.
///
///     x = Rz(φ(t + η) + λ) Tx(τ) Rz(α) Ry(π/2) [r cos θ, r sin θ, 0]ᵀ
///
/// The same code serves simulation, assembly, calibration and diagnosis.
class SensorModel {
 public:
  /// @throws Error for a term that `terms` does not know, or whose parameters are not those it declares
  explicit SensorModel(Calibration calibration, const TermRegistry& terms = {});

  std::size_t lasers() const { return fixed_->chains.size(); }  ///< number of lasers

  /// All parameters in one list: "laser1.lambda", "laser1.tau", "laser1.alpha", "laser1.eta",
  /// "laser1.mirror.cone.kappa", …, "plate.encoder.eccentricity.a", …
  const std::vector<std::string>& names() const { return fixed_->names; }
  std::size_t index(const std::string& name) const;          ///< @throws Error if there is none
  const Eigen::VectorXd& values() const { return values_; }  ///< in the order of names(), in SI units
  /// @throws Error unless there is one value for each of names()
  void set_values(const Eigen::VectorXd& values);

  /// The calibration with the present values.
  Calibration calibration() const;

  /// Places every measurement that encoder readings cover.
  /// @throws Error if `beams` names a laser that the model does not have, or the epochs differ
  Placed place(const Measurements& beams, const PlateTrajectory& plate) const;

  /// The same, run by run in the order of the measurements: for those who have a place of their own for
  /// points.
  void place(const Measurements& beams, const PlateTrajectory& plate, const TakePlaced& take) const;

  /// The same, for those who place scan after scan: `known` spares them sines and cosines.
  void place(const Measurements& beams, const PlateTrajectory& plate, const TakePlaced& take,
             MirrorAngleCache& known) const;

  /// The same, with derivatives with respect to the parameters `free` (indices into values()).
  Placed place(const Measurements& beams, const PlateTrajectory& plate, const std::vector<std::size_t>& free,
               PointDerivatives& derivatives) const;

  /// The chain of one laser, by its index in the calibration.
  const LaserChain& chain(std::size_t laser) const { return fixed_->chains[laser]; }

 private:
  /// Data shared by all parameter values: an optimizer makes thousands of models that differ in values alone.
  struct Fixed {
    explicit Fixed(Calibration given) : calibration(std::move(given)) {}

    Calibration calibration;
    std::vector<std::string> names;
    std::vector<LaserChain> chains;
  };
  static Fixed resolve(Calibration calibration, const TermRegistry& terms);

  std::shared_ptr<const Fixed> fixed_;
  Eigen::VectorXd values_;
  /// The chains as equation (2) alone takes them, at values_.
  std::shared_ptr<const std::vector<simd::BareLaser>> bare_;
};

}  // namespace crisp
