// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <crisp/findings.hpp>

namespace crisp::data {

/// A test of one quantity of the measured residuals against the simulated ones, over one covariate.
struct FitTest {
  std::string covariate;  ///< the test's bins are over it: "beam"
  std::string quantity;   ///< the tested quantity: "noise", "range", "density", "correlation"
  std::string unit;       ///< of the amplitude
  double amplitude = 0;   ///< RMS over the covariate, less what chance makes
  double p_value = 1;     ///< corrected for the number of tests
};

/// Goodness-of-fit statistics of measured data against a model's simulated data.
struct FitStatistics {
  std::vector<FitTest> tests;
  double p_value = 1;  ///< of the fit: the least corrected p-value of the tests
};

/// Šidák-corrects tests that each have a p-value of their own; conservative where the tests are dependent.
FitStatistics corrected(std::vector<FitTest> tests);

/// Goodness of fit of the plain simulation, and of the simulation with the findings. Both have the same
/// tests.
struct GoodnessOfFit {
  std::string scope;  ///< "laser1", "plate"
  FitStatistics before, after;
};

/// Adds to the findings whether measured and simulated residuals are distinguishable, over all scopes, and
/// the tests that reject.
void add_fit_statistics(const std::vector<GoodnessOfFit>& scopes, Findings& to);

/// Adds an unnamed finding for each departure beyond p = 0.002 that neither causes nor unnamed findings
/// explain.
///
/// @param left   goodness of fit of the noise model with all findings
/// @param tests  number of tested scopes
void add_left_over(const std::string& scope, const FitStatistics& left, std::size_t tests, Findings& to);

/// The same for all scopes, with the findings.
void add_left_over(const std::vector<GoodnessOfFit>& scopes, Findings& to);

/// A p-value, "p = 0.012".
std::string chance_in_words(double p_value);

/// Goodness of fit of the simulation, without and with the findings, in words.
std::string fit_statistics_text(const Findings& findings);

}  // namespace crisp::data
