// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/scans/homogeneity_test.hpp"

#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>
#include <numbers>

namespace crisp::diagnose {

HomogeneityTest homogeneity_test(std::vector<ValueWithError> values, Level level, std::size_t blocks) {
  std::erase_if(values, [](const auto& value) { return !std::isfinite(value.first) || !(value.second > 0); });
  double weights = 0;
  double sum = 0;
  for (const auto& [value, error] : values) {
    weights += 1 / (error * error);
    sum += value / (error * error);
  }
  const double at = level == Level::kMean && weights > 0 ? sum / weights : 0;
  const auto n = static_cast<double>(blocks);
  HomogeneityTest about;
  double chi2 = 0;
  double gained = 0;
  for (const auto& [value, error] : values) {
    const double squared = std::pow((value - at) / error, 2);
    chi2 += squared;
    gained += n / 2 * std::log1p(squared / (n - 1));
    about.beyond += (std::pow(value - at, 2) - error * error) / static_cast<double>(values.size());
  }
  const double degrees_of_freedom = static_cast<double>(values.size()) - (level == Level::kMean ? 1 : 0);
  if (!(degrees_of_freedom > 0)) return {};
  about.compared = true;
  about.p_value =
      cdf(complement(boost::math::fisher_f(degrees_of_freedom, n - 1), chi2 / degrees_of_freedom));
  about.log10_bayes_factor = (gained - degrees_of_freedom / 2 * std::log(n)) / std::numbers::ln10;
  return about;
}

}  // namespace crisp::diagnose
