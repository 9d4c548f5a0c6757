// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/watch/recent.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace crisp {
namespace {

/// [s] Half of the usual time between two readings: what is nearer is the same reading.
double half_interval(const PlateTrajectory& piece) {
  if (piece.size() < 2) return 0;
  return 0.5 * (piece.end() - piece.begin()) / static_cast<double>(piece.size() - 1);
}

/// The same share of each batch, but not the same beams: what is not taken is never copied.
void append_share(const Measurements& beams, double share, std::uint64_t lots, Measurements& to) {
  const auto count = static_cast<std::size_t>(std::lround(share * static_cast<double>(beams.size())));
  to.append(count < beams.size() ? thin_evenly({.beams = beams}, count, lots).beams : beams);
}

}  // namespace

void Recent::add(Batch batch) {
  if (batch.beams->size() == 0 || batch.plate->empty()) return;
  batches_.push_back(std::move(batch));
  const double since = latest() - seconds_;
  while (batches_.size() > 1 && batches_.front().beams->time.back() < since) batches_.pop_front();
}

double Recent::latest() const { return batches_.empty() ? 0 : batches_.back().beams->time.back(); }

double Recent::duration() const {
  return batches_.empty() ? 0 : latest() - batches_.front().beams->time.front();
}

Sample sample_of(const std::vector<Recent::Batch>& batches, std::size_t most, PlateTrajectory& plate) {
  std::size_t beams_in_all = 0;
  for (const auto& batch : batches) beams_in_all += batch.beams->size();
  const double share = static_cast<double>(most) / static_cast<double>(beams_in_all);
  std::uint64_t lots = 0;
  std::vector<double> times;
  std::vector<double> angles;
  Sample sample{.plate = &plate};
  for (const auto& [beams, piece] : batches) {
    const double apart = half_interval(*piece);
    for (std::size_t i = 0; i < piece->size(); ++i) {
      if (!times.empty() && piece->times()[i] <= times.back() + apart) continue;
      times.push_back(piece->times()[i]);
      angles.push_back(piece->angles()[i]);
    }
    sample.beams.epoch_ns = beams->epoch_ns;
    append_share(*beams, share, ++lots, sample.beams);
  }
  plate = PlateTrajectory(sample.beams.epoch_ns, std::move(times), std::move(angles),
                          batches.front().plate->max_gap());
  return sample;
}

}  // namespace crisp
