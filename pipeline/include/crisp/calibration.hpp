// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace crisp {

/// Which way a plate turns while its encoder counts up, seen from +z.
enum class CountDirection : std::uint8_t {
  counter_clockwise,
  clockwise,
  automatic  ///< of a rig: not known; a calibration finds it, until then counter_clockwise is assumed
};

/// One parameter of the sensor model, in SI units and radians.
struct Parameter {
  std::string name;      ///< "lambda", "kappa"
  std::string unit;      ///< "m", "rad", "s" or "1"
  double value = 0;      ///< in `unit`
  double std_error = 0;  ///< 0 where it was not estimated
  bool free = false;     ///< whether the calibration turned it
};

/// The parameters of one model term (beyond equation (2)) for one laser or for the plate.
struct TermParameters {
  std::string term;                   ///< "mirror.cone"
  std::vector<Parameter> parameters;  ///< in the order in which the term declares them
};

/// A fault of a term's parameters, or of one of them.
struct TermFault {
  std::string parameter;  ///< "kappa"; empty: it is the term as a whole
  std::string what;       ///< the fault, in words
  std::string advice;     ///< what a person changes
};

/// Owner of a term.
enum class TermOwner { laser, plate };
/// Validates a term's parameters; the readers of calibrations get it from the catalogue of terms.
using JudgeTerm = std::function<std::vector<TermFault>(const TermParameters&, TermOwner)>;

/// Pose of one laser on the plate: equation (2), and its lag of equation (3).
struct LaserCalibration {
  std::string name;                   ///< as the rig calls it: "laser1"
  Parameter lambda{"lambda", "rad"};  ///< λ, azimuth of the laser on the plate
  Parameter tau{"tau", "m"};          ///< τ, distance from the spin axis
  Parameter alpha{"alpha", "rad"};    ///< α, rotation of the scan plane about the plate's normal
  Parameter eta{"eta", "s"};          ///< η, φ_j = φ(t_j + η)
  std::vector<TermParameters> terms;  ///< further terms of this laser
};

/// A parameter, or a combination of several, that the data could not determine.
struct Unobservable {
  std::string parameter;    ///< "laser1.eta"
  std::string reason;       ///< in words
  std::string combination;  ///< what is known instead, in words; empty if nothing is
};

/// Everything that turns measurements into points, with its uncertainty and its origin.
struct Calibration {
  std::vector<LaserCalibration> lasers;                          ///< in the order of the rig
  std::vector<TermParameters> plate_terms;                       ///< terms that affect all lasers
  CountDirection direction = CountDirection::counter_clockwise;  ///< of the encoder that they were found with
  std::vector<std::string> covariance_order;                     ///< "laser1.tau", … the m free parameters
  std::vector<double> covariance;          ///< m × m, row by row, products of their units
  std::map<std::string, double> quality;   ///< "rqe_before", "rqe_after", …
  std::vector<Unobservable> unobservable;  ///< what the data could not determine
  std::vector<std::string> caveats;        ///< why it cannot be trusted, in words; empty if it can
  std::map<std::string, std::string>
      provenance;  ///< what which stages made it, and with which version of crisp

  const LaserCalibration* find(const std::string& laser) const;  ///< nullptr if there is none
};

}  // namespace crisp
