// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/measurement_buffer.hpp"

#include <cmath>
#include <numbers>

#include <crisp/error.hpp>

namespace crisp::estimate {

void MeasurementBuffer::add(std::shared_ptr<const Measurements> beams,
                            std::shared_ptr<const PlateTrajectory> plate) {
  if (pieces_.empty() || pieces_.back() != plate) pieces_.push_back(std::move(plate));
  // Multiples of the golden ratio draw lots evenly, and from the scans of lasers that take turns as well.
  const double turns = static_cast<double>(batches_++) / std::numbers::phi;
  Batch batch{.beams = std::move(beams), .lot = turns - std::floor(turns)};
  if (batch.lot >= share_) {
    left_out_ += batch.beams->size();
    return;
  }
  beams_ += batch.beams->size();
  kept_.push_back(std::move(batch));
  while (beams_ > most_ && kept_.size() > 1) drop_down_to(share_ / 2);
}

void MeasurementBuffer::drop_down_to(double share) {
  share_ = share;
  std::erase_if(kept_, [&](const Batch& batch) {
    if (batch.lot < share_) return false;
    beams_ -= batch.beams->size();
    left_out_ += batch.beams->size();
    return true;
  });
}

Sample MeasurementBuffer::sample() {
  if (beams_ == 0) {
    throw Error("there are no measurements to calibrate from",
                "check the losses counted by the stages above, and the capture's content by crisp info");
  }
  plate_ = joined(pieces_);
  Sample sample{.plate = &plate_};
  sample.beams.epoch_ns = kept_.front().beams->epoch_ns;
  sample.beams.reserve(beams_);
  for (const auto& batch : kept_) sample.beams.append(*batch.beams);
  return sample;
}

}  // namespace crisp::estimate
