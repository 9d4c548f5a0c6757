// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>

#include <crisp/calibration.hpp>

namespace crisp {

/// Change of a metric on held-out data by an extension of the model.
struct Gain {
  std::string metric;            ///< "cloud thickness"
  std::string unit;              ///< "m", "nat"
  double before = 0;             ///< of the model without the extension, in `unit`
  double after = 0;              ///< of the extended model, in `unit`
  std::array<double, 2> ci95{};  ///< of after − before

  /// Whether the whole confidence interval of the change is below 0.
  bool significant_decrease() const { return ci95[1] < 0; }
  /// Whether the whole confidence interval of the change is above 0.
  bool significant_increase() const { return ci95[0] > 0; }
  /// For an RMS: the fraction of the mean square that is explained; 0 where there was nothing.
  double explained() const { return before > 0 ? 1 - after * after / (before * before) : 0; }
};

/// Value of an untested quantity; null in diagnosis.json.
inline constexpr double kNotTested = std::numeric_limits<double>::quiet_NaN();

/// Another cause that could stand in the place of one that was found.
struct OtherCause {
  std::string cause;              ///< "mirror.cone"
  std::string scope;              ///< "plate", "laser3"
  double log10_bayes_factor = 0;  ///< against it
};

/// One of the tests that decide whether a finding becomes part of the model.
struct AcceptanceTest {
  std::string name;               ///< "Wald test"
  double statistic = kNotTested;  ///< in the unit of the threshold
  double threshold = kNotTested;  ///< least statistic, or largest p-value, that passes
  double p_value = kNotTested;    ///< of the statistic under the null hypothesis, where it has one
  bool passed = false;            ///< whether the finding may become part of the model
};

/// A departure of the measured data from the model, with its physical cause.
struct Finding {
  std::string cause;                            ///< "mirror.cone": see docs/effects.md
  std::string scope;                            ///< "plate", "laser3"
  std::vector<Parameter> parameters;            ///< in SI, with standard errors
  double explained_fraction = 0;                ///< share of the whole departure (in squared residuals)
  double log10_bayes_factor = kNotTested;       ///< against the likeliest other cause
  double p_value = 1;                           ///< under noise alone, corrected for the number of tests
  std::vector<std::string> confounded_with;     ///< causes that these data do not distinguish from it
  std::vector<std::string> resolvable_by = {};  ///< what a recording needs to distinguish them
  std::vector<OtherCause> alternatives = {};    ///< a few, the likeliest first; empty: none were compared
  std::vector<Gain> gain;                       ///< on held-out data, one for each metric
  std::vector<AcceptanceTest> tests = {};       ///< in their order; the first that did not pass decided
  bool accepted = false;                        ///< whether it is part of the model from now on
  std::string rejection =
      {};  ///< why it is not; empty: it does not improve the fit on held-out data (cross-validation)

  /// Why it is no part of the model; empty: it is.
  std::string rejection_reason() const;
};

/// A departure that no cause in the catalogue explains.
struct UnnamedFinding {
  std::string covariate;   ///< over which it shows: "mirror angle"
  std::string quantity;    ///< what is off: "range"
  std::string scope;       ///< "plate", "laser3"
  double amplitude = 0;    ///< RMS over the beams
  std::string unit;        ///< of the amplitude
  double p_value = 1;      ///< under noise alone, corrected for the number of tests
  std::vector<Gain> gain;  ///< on held-out data, one for each metric
  bool accepted = false;   ///< whether it is part of the model from now on
};

/// A departure of measured residuals from the simulation, whatever the cause.
struct ResidualDeparture {
  std::string covariate;                ///< over which it shows: "mirror angle", "laser"
  std::string quantity;                 ///< what is off: "range"
  std::string scope;                    ///< "laser3"; "scanner": of all lasers together
  double amplitude = 0;                 ///< RMS of the means over the covariate, less what noise makes
  std::string unit;                     ///< of the amplitude
  double p_value = 1;                   ///< corrected for the number of tests
  double amplitude_after = kNotTested;  ///< with the extended model …
  double p_value_after = kNotTested;    ///< … with the extended model
};

/// Estimates from one device's stamps: its clock, its link and its mirror.
struct DeviceFacts {
  std::string device;                    ///< "laser1", "plate"
  std::size_t stamps = 0;                ///< that were used
  double skew = 0;                       ///< hub seconds a device second − 1
  double skew_std_error = 0;             ///< of it
  double delay_median = 0;               ///< [s] of receipts beyond the shortest delay
  double delay_95 = 0;                   ///< [s] 95 of 100 are not later
  double period = kNotTested;            ///< [s] mean, of a laser's mirror
  double period_std_error = kNotTested;  ///< [s] of `period`
  double nominal_period = kNotTested;    ///< [s]
  double wander = kNotTested;            ///< RMS of slow changes of the mirror's period, as a share of it
};

/// The noise of one laser's ranges, apart from its findings `noise.*`.
struct NoiseFacts {
  std::string laser;       ///< "laser1"
  std::size_t ranges = 0;  ///< that were used
  double sigma = 0;        ///< [m] standard deviation of the remaining normal noise
};

/// A departure that the estimator made by itself: no cause in the scanner.
struct EstimatorArtifact {
  std::string name;                   ///< "density", "aliasing"
  std::vector<Parameter> parameters;  ///< in SI: what shifted by how much, or what describes it
  std::string reason;                 ///< why the estimator makes it
};

/// The result of a diagnosis.
struct Findings {
  std::vector<Finding> findings;                   ///< in the order in which they were taken into the model
  std::vector<UnnamedFinding> unnamed;             ///< in the order in which they were found
  std::vector<ResidualDeparture> departures = {};  ///< that the model as it came, or the extended one, shows
  std::vector<Unobservable> unobservable;          ///< causes that these data could not show
  std::vector<EstimatorArtifact> artifacts;        ///< departures that no scanner made
  std::vector<DeviceFacts> devices;                ///< the rig's lasers, then the plate
  std::vector<NoiseFacts> noise;                   ///< one for each laser
  std::vector<Gain> gain = {};                     ///< of all that became part of the model, together
  double before_p =
      kNotTested;  ///< that the residuals are those of the simulation: with the model that came …
  double after_p = kNotTested;  ///< … and with what was found

  /// Adds another diagnosis of the same recording. The smaller of both p-values counts, Šidák-corrected for
  /// two.
  void append(const Findings& other);
};

}  // namespace crisp
