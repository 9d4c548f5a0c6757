// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/surfel_jacobian.hpp"

#include <numeric>

namespace crisp::estimate {

Measurements with_range_changes(const Measurements& from, std::span<const std::uint32_t> beams,
                                std::span<const double> range_change) {
  Measurements to;
  to.epoch_ns = from.epoch_ns;
  to.reserve(beams.size());
  for (std::size_t k = 0; k < beams.size(); ++k) {
    to.append(from, beams[k]);
    to.range.back() = static_cast<float>(static_cast<double>(to.range.back()) + range_change[k]);
  }
  return to;
}

void fill_surfel_rows(const SensorModel& model, const Measurements& beams, const PlateTrajectory& plate,
                      const std::vector<std::size_t>& free, const Eigen::Vector3d& normal,
                      const std::vector<std::size_t>& columns, std::size_t stride, std::span<double> rows) {
  PointDerivatives derivatives;
  const Placed placed = model.place(beams, plate, free, derivatives);
  for (std::size_t k = 0; k < placed.index.size(); ++k) {
    const std::size_t row = placed.index[k];
    const auto& own = derivatives.columns[beams.laser[row]];
    for (std::size_t c = 0; c < own.size(); ++c) {
      const auto column = static_cast<Eigen::Index>(k * derivatives.stride + c);
      rows[row * stride + columns[own[c]]] = normal.dot(derivatives.values.col(column));
    }
  }
}

quality::DerivativeRows surfel_rows(const SensorModel& model, const Sample& sample,
                                    const std::vector<std::size_t>& free) {
  std::vector<std::size_t> columns(free.size());
  std::iota(columns.begin(), columns.end(), std::size_t{0});
  return [&, columns](const quality::Surfel& surfel, std::span<const std::uint32_t> beams,
                      std::span<const double> range_change, std::span<double> rows) {
    fill_surfel_rows(model, with_range_changes(sample.beams, beams, range_change), *sample.plate, free,
                     surfel.normal, columns, free.size(), rows);
  };
}

}  // namespace crisp::estimate
