// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace crisp::diagnose {

/// n values with their normal mixture of up to four components. All arrays have n elements.
struct MixtureBlock {
  static constexpr std::size_t kMaxComponents = 4;

  struct Component {
    const double* share = nullptr;  ///< prior probability
    const double* mean = nullptr;   ///< [m]
    double scale = 1;               ///< relative to `deviation`
    double* probability = nullptr;  ///< out: posterior probability of this component
  };

  std::size_t size = 0;
  const double* value = nullptr;      ///< [m]
  const double* deviation = nullptr;  ///< [m] standard deviation of a component of scale 1
  std::size_t components = 0;
  Component component[kMaxComponents];
  double* log_density = nullptr;  ///< out: ln of the mixture's density [1/m] at the value
};

}  // namespace crisp::diagnose

namespace crisp::simd {

/// The expectation step of EM for normal mixtures. Densities are at least 1e-300.
void expect(const diagnose::MixtureBlock& block);

}  // namespace crisp::simd
