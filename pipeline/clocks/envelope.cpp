// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/clocks/envelope.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/clocks/series.hpp"

namespace crisp::clocks {

Eigen::MatrixXd Envelope::straight() const {
  Eigen::MatrixXd base(time.size(), 2);
  base.col(0).setOnes();
  base.col(1) = time.array() - time.mean();
  return base;
}

double Envelope::line(const Eigen::VectorXd& values, double at) const {
  return values[0] + values[1] * (at - time.mean());
}

Envelope envelope_of(std::span<const Stamp> stamps) {
  constexpr std::size_t kOfStretch = 12;
  const std::size_t stretches = std::clamp<std::size_t>(stamps.size() / kOfStretch, 6, 64);
  Envelope envelope;
  envelope.time.resize(static_cast<Eigen::Index>(stretches));
  envelope.lead.resize(static_cast<Eigen::Index>(stretches));
  // Within a stretch the clock's own slope counts: by the line through all of them.
  const double span = receipt_of(stamps.back()) - receipt_of(stamps.front());
  const double slope = (stamps.back().lead - stamps.front().lead) / std::max(1e-9, span);
  for (std::size_t w = 0; w < stretches; ++w) {
    const std::size_t begin = w * stamps.size() / stretches;
    const std::size_t end = (w + 1) * stamps.size() / stretches;
    std::size_t least = begin;
    const auto height = [&](std::size_t i) { return stamps[i].lead - slope * receipt_of(stamps[i]); };
    for (std::size_t i = begin; i < end; ++i) {
      if (height(i) < height(least)) least = i;
    }
    envelope.first.push_back(begin);
    envelope.stamp.push_back(least);
    envelope.time[static_cast<Eigen::Index>(w)] = receipt_of(stamps[least]);
    envelope.lead[static_cast<Eigen::Index>(w)] = stamps[least].lead;
  }
  envelope.first.push_back(stamps.size());
  return envelope;
}

Eigen::MatrixXd bend_and_steps(const Eigen::VectorXd& time, Eigen::Index margin) {
  const Eigen::MatrixXd all_steps = steps(time.size(), margin);
  Eigen::MatrixXd columns(time.size(), 1 + all_steps.cols());
  columns << (time.array() - time.mean()).square().matrix(), all_steps;
  return columns;
}

}  // namespace crisp::clocks
