// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/measurements_stage.hpp"

#include <crisp/measurement_tables.hpp>

namespace crisp::write {

void WriteMeasurementsStage::describe(StageDescription<WriteMeasurementsStage>& d) {
  d.name("write.measurements").summary("writes raw measurements, for processing in another run");
  d.details(
      "NAME.pcd holds a row for each measurement: range, mirror_angle, time, plate_angle, laser, beam and remission, in metres, radians and seconds since the epoch in the header's comment. NAME.plate.pcd holds the encoder readings. No calibration is applied. `grabber.pcd` restores exactly the same measurements.\n\n"
      "Where the plate's trajectory comes in pieces (recordings of several minutes), so do the files.");
  d.takes<Measurements>().holds<PlateTrajectory>();
  describe_parts(d, &WriteMeasurementsStage::options_, {"<stem>.plate.pcd", "<stem>_####.plate.pcd"});
}

void WriteMeasurementsStage::process(const Inputs& in, Outputs&, Context&) {
  if (!writer_) writer_.emplace(options_.file, options_.format);
  const auto& beams = in.get<Measurements>();
  if (beams.size() == 0) return;
  auto plate = in.share<PlateTrajectory>();
  const bool full =
      pending_.size() > 0 && (plate != plate_ || options_.is_full(pending_.size() + beams.size() - 1,
                                                                  pending_.time.front(), beams.time.front()));
  if (full) write_part(true);
  plate_ = std::move(plate);
  pending_.append(beams);
}

void WriteMeasurementsStage::write_part(bool more) {
  const auto file = writer_->write(to_pcd_table(pending_, *plate_), more);
  writer_->write_next_to(plate_path(file), to_pcd_table(*plate_));
  written_ += pending_.size();
  pending_ = {};
}

void WriteMeasurementsStage::finish(Outputs&, Context& context) {
  if (pending_.size() == 0) {
    throw Error("there are no measurements to write",
                "see the losses and warnings above for the cause; without any, no stage above gave one");
  }
  write_part(false);
  finish_parts(*writer_, written_, "measurements", context);
}

}  // namespace crisp::write
