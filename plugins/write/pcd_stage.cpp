// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/pcd_stage.hpp"

#include <algorithm>
#include <utility>

#include <crisp/cloud_conversion.hpp>

#include "plugins/write/finite_points.hpp"

namespace crisp::write {

void WritePcdStage::describe(StageDescription<WritePcdStage>& d) {
  d.name("write.pcd").summary("writes the cloud as a PCD file");
  d.details(
      "All incoming clouds become one, with the fields x, y, z, intensity, laser, beam and time: seconds, as double, since the epoch that the comment `# crisp epoch_ns` in the header gives in nanoseconds since 1970. PCL reads it. A recording that is too long for one file is split, which bounds the memory; and data after a pause of 5 s, possibly of another place, go to a file of their own: a pause of the encoder readings or, where no stage above gives these, between two clouds. The files appear when all of them are complete.");
  d.takes<Cloud>().takes<PlateTrajectory>(Need::optional);
  describe_parts(d, &WritePcdStage::options_);
}

void WritePcdStage::process(const Inputs& in, Outputs&, Context& context) {
  if (const auto plate = in.share<PlateTrajectory>()) {
    borders_.add(*plate);
    return;
  }
  if (!writer_) writer_.emplace(options_.file, options_.format);
  const Cloud& cloud = in.get<Cloud>();
  if (written_ == 0 && pending_.empty()) pending_.header = cloud.header;
  bool is_first = true;
  const std::size_t lost = for_each_finite_point(cloud, pending_.header.stamp, [&](const Point& point) {
    if (std::exchange(is_first, false)) borders_.begin_cloud(point.time);
    add(point);
  });
  context.count(kNotFinite, lost);
}

void WritePcdStage::add(const Point& point) {
  const std::size_t recording = borders_.number(point.time);
  const bool is_of_next = recording > recording_;
  if (!pending_.empty() &&
      (is_of_next || options_.is_full(pending_.size(), pending_.front().time, point.time))) {
    writer_->write(to_pcd_table(pending_), true);
    written_ += pending_.size();
    pending_.clear();
  }
  recording_ = std::max(recording_, recording);
  pending_.push_back(point);
}

void WritePcdStage::finish(Outputs&, Context& context) {
  if (pending_.empty()) {
    throw no_point_came();
  }
  writer_->write(to_pcd_table(pending_), false);
  finish_parts(*writer_, written_ + pending_.size(), "points", context);
}

}  // namespace crisp::write
