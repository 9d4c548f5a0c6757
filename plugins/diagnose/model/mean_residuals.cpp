// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/mean_residuals.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <numeric>

#include "pipeline/statistics/robust_estimators.hpp"

namespace crisp::diagnose {

std::vector<double> means_in(const QuantileBins& layout, const WeightedResiduals& residuals) {
  std::vector<double> means;
  for (std::size_t b = 0; b + 1 < layout.first.size(); ++b) {
    double sum = 0;
    double slope = 0;
    for (std::size_t k = layout.first[b]; k < layout.first[b + 1]; ++k) {
      const double weight = residuals.weight[layout.residual[k]];
      sum += weight * residuals.value[layout.residual[k]];
      slope += statistics::biweight_psi_derivative(weight);
    }
    means.push_back(slope > 0 ? sum / slope : 0);
  }
  if (layout.profile.laser == kAllLasers) return means;
  const double mean = std::accumulate(means.begin(), means.end(), 0.0) / static_cast<double>(means.size());
  for (double& one : means) one -= mean;
  return means;
}

double profile_p_value(const QuantileBins& layout, const std::vector<double>& means,
                       const std::vector<double>& errors) {
  double chi2 = 0;
  for (std::size_t b = 0; b < means.size(); ++b) {
    if (errors[b] > 0) chi2 += std::pow(means[b] / errors[b], 2);
  }
  const auto bins = static_cast<double>(means.size());
  const double free = layout.profile.laser == kAllLasers ? bins : bins - 1;
  return cdf(complement(boost::math::chi_squared(free), chi2 * free / bins));
}

double systematic_rms(const std::vector<double>& means, const std::vector<double>& errors) {
  double square = 0;
  for (std::size_t b = 0; b < means.size(); ++b) square += means[b] * means[b] - errors[b] * errors[b];
  return std::sqrt(std::max(0.0, square / static_cast<double>(means.size())));
}

}  // namespace crisp::diagnose
