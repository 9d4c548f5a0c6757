// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "pipeline/data/calibration.hpp"

namespace crisp {

/// What data leave open.
struct Observability {
  std::vector<std::size_t> known;  ///< those of the free parameters that the data determine
  std::vector<Unobservable> unobservable;
};

/// Looks for directions that the data do not determine better than was known before: eigenvectors of
/// D F D with an eigenvalue below 1. Of each such direction one parameter is named unobservable (an η before
/// an α, a λ or a τ, since it is the one whose prior is kept), with the combinations that are known all the
/// same.
///
/// @param information  m × m: Fisher's information F on the free parameters
/// @param free         m indices into `names`
/// @param prior        m standard deviations D of what was known before, in the parameters' units
Observability observability(const Eigen::MatrixXd& information, const std::vector<std::size_t>& free,
                            const std::vector<std::string>& names, const Eigen::VectorXd& prior);

/// What is known although one parameter is not: each of the known ones with what makes up for it, where that
/// is no small part: "tau + 0.98 * y, alpha - 1.2 * y". Empty if nothing does.
///
/// @param held    index of the one that is not
/// @param known   indices of those that are
/// @param scaled  Fisher's information in units of `scale`
/// @param scale   of each parameter, in its unit: what counts as one of it
std::string known_with(std::size_t held, const std::vector<std::size_t>& known, const Eigen::MatrixXd& scaled,
                       const std::vector<std::string>& names, const Eigen::VectorXd& scale);

}  // namespace crisp
