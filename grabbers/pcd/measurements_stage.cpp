// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/pcd/measurements_stage.hpp"

#include <fmt/format.h>

#include <algorithm>

#include <crisp/measurement_tables.hpp>

#include "grabbers/pcd/surplus_points.hpp"
#include "pipeline/pcd/parts.hpp"

namespace crisp::pcd_grabber {
namespace {

constexpr std::size_t kAtOnce = 1 << 15;  // measurements in one item: enough that an item costs nothing

Measurements some_of(const Measurements& all, std::size_t begin, std::size_t end) {
  const auto slice = [&](const auto& values) {
    return std::remove_cvref_t<decltype(values)>(values.begin() + static_cast<std::ptrdiff_t>(begin),
                                                 values.begin() + static_cast<std::ptrdiff_t>(end));
  };
  return {.epoch_ns = all.epoch_ns,
          .range = slice(all.range),
          .mirror_angle = slice(all.mirror_angle),
          .time = slice(all.time),
          .laser = slice(all.laser),
          .remission = slice(all.remission),
          .beam = slice(all.beam)};
}

void refuse_other_rigs(const Measurements& beams, const Rig& rig) {
  const auto largest = std::max_element(beams.laser.begin(), beams.laser.end());
  if (largest != beams.laser.end() && *largest >= rig.lasers.size()) {
    throw Error(
        fmt::format("has measurements of laser {}, but the rig has {}", *largest + 1, rig.lasers.size()),
        "give the rig of the recording: --rig");
  }
}

}  // namespace

void GrabMeasurementsStage::describe(StageDescription<GrabMeasurementsStage>& d) {
  d.name("grabber.pcd").summary("reads raw measurements of an earlier run");
  d.details(
      "Gives exactly the measurements of write.measurements. Where NAME.plate.pcd is missing, the plate's trajectory is made of the plate angles of the measurements; it then ends with them.");
  d.gives<PlateTrajectory>().gives<Measurements>();
  d.option("file", &GrabMeasurementsStage::file_, "input file NAME.pcd of write.measurements").required();
  d.option("max_gap", &GrabMeasurementsStage::max_gap_,
           "longest silence of the encoder to interpolate across, where NAME.plate.pcd is missing")
      .unit("s")
      .range(1e-4, 10);
}

void GrabMeasurementsStage::process(const Inputs&, Outputs& out, Context& context) {
  pcd::read_parts(file_, [&](const PcdTable& table, const std::filesystem::path& file) {
    context.reads(file);
    if (!table.has("range") && table.has("x")) {
      throw Error(file.string() + " holds a cloud, no measurements", "read it with grabber.cloud");
    }
    const auto read = about(file, [&] { return measurements_of(table); });
    const Measurements& beams = read.beams;
    context.count("impossible measurements", read.impossible);
    count_surplus(table, file, context);
    about(file, [&] { refuse_other_rigs(beams, context.rig()); });
    out.give(trajectory(table, file, context));
    for (std::size_t begin = 0; begin < beams.size() && !context.interrupted(); begin += kAtOnce) {
      out.give(some_of(beams, begin, std::min(begin + kAtOnce, beams.size())));
    }
  });
}

PlateTrajectory GrabMeasurementsStage::trajectory(const PcdTable& table, const std::filesystem::path& file,
                                                  Context& context) const {
  const auto plate_file = plate_path(file);
  if (!std::filesystem::exists(plate_file)) {
    context.warn(plate_file.string() +
                 " is missing: the plate's trajectory is made of the measurements' angles");
    return about(file, [&] { return trajectory_between(table, max_gap_); });
  }
  context.reads(plate_file);
  const PcdTable readings = read_pcd(plate_file);
  if (!about(plate_file, [&] { return belong_together(table, readings); })) {
    throw Error(file.string() + " and " + plate_file.filename().string() +
                    " are of different runs, as after an interrupted one",
                "repeat the run, which writes both anew; if one was edited, remove its line `# crisp plate`");
  }
  count_surplus(readings, plate_file, context);
  return about(plate_file, [&] { return trajectory_of(readings); });
}

}  // namespace crisp::pcd_grabber
