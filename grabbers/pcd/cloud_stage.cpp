// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/pcd/cloud_stage.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include <crisp/cloud_conversion.hpp>

#include "grabbers/pcd/surplus_points.hpp"
#include "pipeline/pcd/parts.hpp"

namespace crisp::pcd_grabber {
namespace {

/// Warning of rounded doubles, if the rounding exceeds a cloud's own noise.
std::string rounding_in_words(double rounding, const std::array<double, 3>& shift) {
  return fmt::format(
      "its coordinates are rounded to floats, which changes them by up to {:.3g} m; to avoid it, subtract a shift: shift: [{:.0f}m, {:.0f}m, {:.0f}m]",
      rounding, shift[0], shift[1], shift[2]);
}

}  // namespace

void GrabCloudStage::describe(StageDescription<GrabCloudStage>& d) {
  d.name("grabber.cloud").summary("reads a cloud from a PCD file");
  d.details(
      "Reads PCD files of any program, in all their formats: x, y and z are required; missing intensity, laser, beam and time are 0; other fields, and the order of an image, are dropped. A cloud that write.pcd wrote as several files is read piece by piece.\n\n"
      "Coordinates of a cloud are single precision (float), as in PCL: exact to a tenth of a millimetre up to 1 km from the origin. Double coordinates far from it, on a map's grid for example, are rounded with a warning; subtract a shift.");
  d.gives<Cloud>();
  d.option("file", &GrabCloudStage::file_, "PCD file, or base name of a cloud in several files").required();
  d.option("shift", &GrabCloudStage::shift_,
           "offset subtracted from x, y and z before rounding to single precision")
      .unit("m")
      .range(-1e9, 1e9)
      .count(3, 3);
}

void GrabCloudStage::process(const Inputs&, Outputs& out, Context& context) {
  constexpr double kVisible = 1e-4;  // [m]
  double rounding = 0;
  std::array<double, 3> shift{};
  pcd::read_parts(file_, [&](const PcdTable& table, const std::filesystem::path& file) {
    if (!table.has("x") && table.has("range")) {
      throw Error(file.string() + " holds measurements, no cloud", "read it with grabber.pcd");
    }
    auto [cloud, not_finite, change] = about(file, [&] {
      return cloud_of(table, {shift_[0], shift_[1], shift_[2]});
    });
    if (const auto lost = dropped_fields(table); !lost.empty())
      context.warn(fmt::format("{}: not kept are {}", file.string(), fmt::join(lost, "; ")));
    if (rounding == 0 && change > 0) shift = suggested_shift(table);
    rounding = std::max(rounding, change);
    context.reads(file);
    context.count("points with coordinates that are no numbers", not_finite);
    count_surplus(table, file, context);
    if (!context.interrupted()) out.give(std::move(cloud));
  });
  if (rounding > kVisible) context.warn(rounding_in_words(rounding, shift));
}

}  // namespace crisp::pcd_grabber
