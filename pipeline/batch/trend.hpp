// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "pipeline/batch/table.hpp"

namespace crisp::batch {

/// One recording's estimate of a parameter.
struct TrendPoint {
  std::string recording;
  double value = 0;
  double std_error = 0;
  double p_value =
      1;  ///< that it is the parameter's centre but for its error, corrected for all tests (Šidák)
};

/// A parameter over the recordings of a batch, in SI.
struct ParameterTrend {
  std::string name;         ///< "laser1.tau"
  std::string unit;         ///< "m", "rad", "s" or "1"
  double centre = 0;        ///< weighted median of the recordings, by the inverse squares of their errors
  double centre_error = 0;  ///< its standard error
  double chi2 = 0;          ///< of the values about it, per degree of freedom
  std::vector<TrendPoint>
      points;  ///< in the order of the recordings' time; where it is not known, of their names
};

/// Probability below which a recording stands out: of a hundred batches without any change, one shows one.
inline constexpr double kStandsOut = 0.01;

/// The parameters that at least three trusted recordings estimated. A recording stands out where its distance
/// from the centre is larger than both standard errors allow. Angles differ by less than half a turn.
std::vector<ParameterTrend> batch_trend(const std::vector<BatchRow>& rows);

/// Fills `stands_out` of the rows.
void mark_outstanding(const std::vector<ParameterTrend>& trends, std::vector<BatchRow>& rows);

/// A plot a parameter, with what stands out apart from the others. SVG.
std::string trend_svg(const std::vector<ParameterTrend>& trends);

/// For programs: a parameter each, without its points.
nlohmann::ordered_json trend_json(const std::vector<ParameterTrend>& trends);

}  // namespace crisp::batch
