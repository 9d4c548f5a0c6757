// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/pcd/cloud_stage.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "grabbers/pcd/surplus.hpp"
#include "pipeline/pcd/cloud_table.hpp"
#include "pipeline/pcd/parts.hpp"

namespace crisp {
namespace {

/// What became of doubles, if it is more than a cloud's own noise would hide.
std::string rounding_in_words(double rounding, const std::array<double, 3>& shift) {
  return fmt::format(
      "its coordinates are kept as floats, which changes them by up to {:.3g} m; to keep them, subtract a "
      "shift: shift: [{:.0f}m, {:.0f}m, {:.0f}m]",
      rounding, shift[0], shift[1], shift[2]);
}

}  // namespace

void GrabCloudStage::describe(StageDescription<GrabCloudStage>& d) {
  d.name("grabber.cloud").summary("reads the cloud of a PCD file");
  d.details(
      "Of any program's PCD files, in all their formats: x, y and z must be there; intensity, laser, beam "
      "and "
      "time are 0 where they are not; other fields, and the order of an image, are not kept. A cloud that "
      "write.pcd wrote in several files comes in as many "
      "pieces.\n\n"
      "Coordinates of a cloud are single (float), as PCL's are: exact to a tenth of a millimetre up to 1 km "
      "from the origin. A file with doubles far from it, on a map's grid say, is rounded, and warned of; "
      "subtract a shift.");
  d.gives<Cloud>();
  d.option("file", &GrabCloudStage::file_,
           "the PCD file, or the name that a cloud in several files was given")
      .required();
  d.option("shift", &GrabCloudStage::shift_, "what is subtracted from x, y and z before they become single")
      .unit("m")
      .range(-1e9, 1e9)
      .count(3, 3);
}

void GrabCloudStage::process(const Inputs&, Outputs& out, Context& context) {
  constexpr double kVisible = 1e-4;  // [m]
  double rounding = 0;
  std::array<double, 3> shift{};
  read_parts(file_, [&](const PcdTable& table, const std::filesystem::path& file) {
    if (!table.has("x") && table.has("range")) {
      throw Error(file.string() + " holds measurements, no cloud", "read it with grabber.pcd");
    }
    auto [cloud, not_finite, change] = about(file, [&] {
      return cloud_of(table, {shift_[0], shift_[1], shift_[2]});
    });
    if (const auto lost = not_kept(table); !lost.empty())
      context.warn(fmt::format("{}: not kept are {}", file.string(), fmt::join(lost, "; ")));
    if (rounding == 0 && change > 0) shift = suggested_shift(table);
    rounding = std::max(rounding, change);
    context.reads(file);
    context.count("points that are not numbers", not_finite);
    count_surplus(table, file, context);
    if (!context.interrupted()) out.give(std::move(cloud));
  });
  if (rounding > kVisible) context.warn(rounding_in_words(rounding, shift));
}

}  // namespace crisp
