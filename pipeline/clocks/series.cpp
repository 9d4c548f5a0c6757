// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/clocks/series.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "pipeline/statistics/dense_solvers.hpp"

namespace crisp::clocks {

Eigen::MatrixXd off_base(const Eigen::MatrixXd& base, const Eigen::MatrixXd& columns) {
  const Eigen::MatrixXd orthonormal =
      base.householderQr().householderQ() * Eigen::MatrixXd::Identity(base.rows(), base.cols());
  return columns - orthonormal * (orthonormal.transpose() * columns);
}

SeriesFit best_in_series(const Eigen::MatrixXd& base, const Eigen::MatrixXd& columns,
                         const Eigen::VectorXd& values) {
  const Eigen::MatrixXd unit = off_base(base, columns).colwise().normalized();
  SeriesFit fit;
  const Eigen::VectorXd products = unit.transpose() * off_base(base, values);
  fit.product = products.cwiseAbs().maxCoeff(&fit.column);
  Eigen::MatrixXd both(base.rows(), base.cols() + 1);
  both << base, columns.col(fit.column);
  fit.values = statistics::least_squares(both, values);
  const double squares = (values - both * fit.values).squaredNorm();
  const double variance = squares / static_cast<double>(std::max<Eigen::Index>(1, both.rows() - both.cols()));
  fit.errors = (variance * statistics::inverse(both.transpose() * both).diagonal()).cwiseSqrt();
  fit.rms = std::sqrt(squares / static_cast<double>(std::max<Eigen::Index>(1, values.size())));
  return fit;
}

Eigen::MatrixXd steps(Eigen::Index n, Eigen::Index margin) {
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(n, std::max<Eigen::Index>(0, n - 2 * margin + 1));
  for (Eigen::Index k = 0; k < columns.cols(); ++k) columns.col(k).tail(n - margin - k).setOnes();
  return columns;
}

Eigen::Index before_step(const Eigen::VectorXd& column) { return (column.array() == 0).count(); }

}  // namespace crisp::clocks
