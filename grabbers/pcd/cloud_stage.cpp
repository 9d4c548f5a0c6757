// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/pcd/cloud_stage.hpp"

#include "pipeline/pcd/cloud_table.hpp"
#include "pipeline/pcd/parts.hpp"

namespace crisp {

void GrabCloudStage::describe(StageDescription<GrabCloudStage>& d) {
  d.name("grabber.cloud").summary("reads the cloud of a PCD file");
  d.details(
      "Of any program's PCD files, in all their formats: x, y and z must be there; intensity, laser, beam "
      "and "
      "time are 0 where they are not. A cloud that write.pcd wrote in several files comes in as many "
      "pieces.");
  d.gives<Cloud>();
  d.option("file", &GrabCloudStage::file_,
           "the PCD file, or the name that a cloud in several files was given")
      .required();
}

void GrabCloudStage::process(const Inputs&, Outputs& out, Context& context) {
  read_parts(file_, [&](const PcdTable& table, const std::filesystem::path& file) {
    if (!table.has("x") && table.has("range")) {
      throw Error(file.string() + " holds measurements, no cloud", "read it with grabber.pcd");
    }
    auto [cloud, not_finite] = about(file, [&] { return cloud_of(table); });
    context.reads(file);
    context.count("points that are not numbers", not_finite);
    if (!context.interrupted()) out.give(std::move(cloud));
  });
}

}  // namespace crisp
