// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/watch/sliding_window.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace crisp::calibrate {
namespace {

/// The same share of each batch, but not the same beams: what is not taken is never copied.
void append_share(const Measurements& beams, double share, std::uint64_t lots, Measurements& to) {
  const auto count = static_cast<std::size_t>(std::lround(share * static_cast<double>(beams.size())));
  to.append(count < beams.size() ? estimate::thin_evenly({.beams = beams}, count, lots).beams : beams);
}

}  // namespace

void SlidingWindow::add(Batch batch) {
  if (batch.beams->size() == 0 || batch.plate->empty()) return;
  batches_.push_back(std::move(batch));
  const double since = latest() - seconds_;
  while (batches_.size() > 1 && batches_.front().beams->time.back() < since) batches_.pop_front();
}

double SlidingWindow::latest() const { return batches_.empty() ? 0 : batches_.back().beams->time.back(); }

double SlidingWindow::duration() const {
  return batches_.empty() ? 0 : latest() - batches_.front().beams->time.front();
}

estimate::Sample sample_of(const std::vector<SlidingWindow::Batch>& batches, std::size_t most,
                           PlateTrajectory& plate) {
  std::size_t beams_in_all = 0;
  for (const auto& batch : batches) beams_in_all += batch.beams->size();
  const double share = static_cast<double>(most) / static_cast<double>(beams_in_all);
  std::uint64_t lots = 0;
  std::vector<std::shared_ptr<const PlateTrajectory>> pieces;
  estimate::Sample sample{.plate = &plate};
  for (const auto& [beams, piece] : batches) {
    if (pieces.empty() || pieces.back() != piece) pieces.push_back(piece);
    sample.beams.epoch_ns = beams->epoch_ns;
    append_share(*beams, share, ++lots, sample.beams);
  }
  plate = estimate::joined(pieces);
  return sample;
}

}  // namespace crisp::calibrate
