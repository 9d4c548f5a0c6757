// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include <crisp/calibration.hpp>

namespace crisp::estimate {

/// Unobservable parameters of the data.
struct Observability {
  std::vector<std::size_t> known;  ///< those of the free parameters that the data determine
  std::vector<Unobservable> unobservable;
};

/// Finds unobservable directions: eigenvectors of D F D with an eigenvalue below 1, which the data determine
/// no better than the prior. One parameter of each such direction is named unobservable (an η before an α, a
/// λ or a τ, since its prior is kept), with the combinations that remain known.
///
/// @param information  m × m: Fisher's information F on the free parameters
/// @param free         m indices into `names`
/// @param prior        m standard deviations D of what was known before, in the parameters' units
Observability observability(const Eigen::MatrixXd& information, const std::vector<std::size_t>& free,
                            const std::vector<std::string>& names, const Eigen::VectorXd& prior);

/// Identifiable combinations although one parameter is unobservable: each of the known ones with its
/// compensation, where that is no small part: "tau + 0.98 * y, alpha - 1.2 * y". Empty if there is none.
///
/// @param held    index of the unobservable parameter
/// @param known   indices of the known ones
/// @param scaled  Fisher's information in units of `scale`
/// @param scale   of each parameter, in its unit: its unit of comparison
std::string known_with(std::size_t held, const std::vector<std::size_t>& known, const Eigen::MatrixXd& scaled,
                       const std::vector<std::string>& names, const Eigen::VectorXd& scale);

}  // namespace crisp::estimate
