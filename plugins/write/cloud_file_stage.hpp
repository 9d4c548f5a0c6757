// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <utility>

#include <crisp/cloud.hpp>
#include <crisp/context.hpp>
#include <crisp/plate_trajectory.hpp>
#include <crisp/stage.hpp>

#include "plugins/write/finite_points.hpp"
#include "plugins/write/recording_borders.hpp"

namespace crisp::write {

/// `write.ply`, `write.las`: all clouds that come, as one, in a file that is written while they come.
template <class Writer>
class CloudFileStage final : public Stage {
 public:
  static void describe(StageDescription<CloudFileStage>& d) {
    d.name(Writer::kStage).summary(Writer::kSummary);
    d.details(
        std::string(Writer::kDetails) +
        "\n\nAll incoming clouds become one file. It is written while they arrive, with bounded memory, and takes its name when it is complete. Recordings separated by a pause of 5 s, possibly of different places, share the file, with a warning; `write.pcd` separates them.");
    d.template takes<Cloud>().template takes<PlateTrajectory>(Need::optional);
    d.option("file", &CloudFileStage::file_, std::string("output file, NAME") + Writer::kEnding)
        .writes()
        .ending(Writer::kEnding)
        .required();
  }

  void process(const Inputs& in, Outputs&, Context& context) override {
    if (const auto plate = in.share<PlateTrajectory>()) {
      borders_.add(*plate);
      return;
    }
    const Cloud& cloud = in.get<Cloud>();
    if (!writer_) stamp_ = cloud.header.stamp;
    bool is_first = true;
    const std::size_t lost = for_each_finite_point(cloud, stamp_, [&](const Point& point) {
      if (std::exchange(is_first, false)) borders_.begin_cloud(point.time);
      if (!writer_) writer_.emplace(file_, stamp_, point);
      recording_ = std::max(recording_, borders_.number(point.time));
      writer_->add(point, recording_);
    });
    context.count(kNotFinite, lost);
  }

  void finish(Outputs&, Context& context) override {
    if (!writer_) throw no_point_came();
    for (const auto& [what, n] : writer_->losses()) context.count(what, n);
    for (auto& warning : writer_->warnings()) context.warn(std::move(warning));
    writer_->commit();
    context.wrote(file_);
    if (recording_ > 0) {
      context.warn(fmt::format(
          "{} holds {} recordings with pauses between them; if they are of different places, use write.pcd, which separates them",
          file_.string(), recording_ + 1));
    }
    context.print(fmt::format("{} points in {}", writer_->points(), file_.string()));
    context.report({{"points", writer_->points()}, {"files", {file_.string()}}});
  }

 private:
  std::filesystem::path file_;
  std::uint64_t stamp_ = 0;
  std::optional<Writer> writer_;
  RecordingBorders borders_;
  std::size_t recording_ = 0;
};

}  // namespace crisp::write
