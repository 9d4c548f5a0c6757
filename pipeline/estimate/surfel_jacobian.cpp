// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/surfel_jacobian.hpp"

namespace crisp {
namespace {

Measurements picked_beams(const Measurements& from, std::span<const std::uint32_t> beams,
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

}  // namespace

DerivativeRows surfel_rows(const SensorModel& model, const Sample& sample,
                           const std::vector<std::size_t>& free) {
  return [&](const Surfel& surfel, std::span<const std::uint32_t> beams, std::span<const double> range_change,
             std::span<double> rows) {
    PointDerivatives derivatives;
    const Measurements some = picked_beams(sample.beams, beams, range_change);
    const Placed placed = model.place(some, *sample.plate, free, derivatives);
    for (std::size_t k = 0; k < placed.index.size(); ++k) {
      const std::size_t row = placed.index[k];
      const auto& columns = derivatives.columns[some.laser[row]];
      for (std::size_t c = 0; c < columns.size(); ++c) {
        const auto column = static_cast<Eigen::Index>(k * derivatives.stride + c);
        rows[row * free.size() + columns[c]] = surfel.normal.dot(derivatives.values.col(column));
      }
    }
  };
}

}  // namespace crisp
