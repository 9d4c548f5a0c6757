// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/picture_stage.hpp"

#include <fmt/format.h>

#include "pipeline/files/atomic_file.hpp"
#include "plugins/write/parts_options.hpp"

namespace crisp {

void WritePictureStage::describe(StageDescription<WritePictureStage>& d) {
  d.name("write.picture").summary("draws the cloud as a PNG picture");
  d.details(
      "Parallel projection, each laser in a colour of its own (blue, orange, green, and again), with brightness by the number of points in a pixel: disagreement between lasers shows as seams of colour, agreement as white.");
  d.takes<Cloud>();
  d.option("file", &WritePictureStage::file_, "output file, NAME.png").writes().ending(".png").required();
  d.option("view", &WritePictureStage::settings_, &PictureSettings::view,
           "view: top (x to the right, y upwards), front (x, z) or side (y, z)")
      .choices({{"top", PictureView::top}, {"front", PictureView::front}, {"side", PictureView::side}});
  d.option("depth", &WritePictureStage::depth_,
           "depth limits of the drawn points: heights for top, y for front, x for side")
      .unit("m")
      .count(0, 2);
  d.option("across", &WritePictureStage::settings_, &PictureSettings::across,
           "width of the view from edge to edge")
      .unit("m")
      .range(1e-3, 1e6);
  d.option("centre", &WritePictureStage::centre_, "centre of the view").unit("m").count(2, 2);
  d.option("width", &WritePictureStage::settings_, &PictureSettings::width, "width in pixels")
      .range(1, 20000);
  d.option("height", &WritePictureStage::settings_, &PictureSettings::height, "height in pixels")
      .range(1, 20000);
}

void WritePictureStage::check(const RunSettings&) const {
  if (depth_.size() == 1 || (depth_.size() == 2 && depth_[0] >= depth_[1])) {
    throw Error("the depth needs two limits, the lower one first", "for instance depth: [0.5m, 1.5m]");
  }
}

void WritePictureStage::process(const Inputs& in, Outputs&, Context&) {
  if (!painter_) {
    PictureSettings settings = settings_;
    settings.centre = {centre_[0], centre_[1]};
    if (!depth_.empty() && settings.view == PictureView::front) {
      settings.depth = {-depth_[1], -depth_[0]};  // towards the eye
    } else if (!depth_.empty()) {
      settings.depth = {depth_[0], depth_[1]};
    }
    painter_.emplace(settings);
  }
  drawn_ += painter_->add(in.get<Cloud>());
}

void WritePictureStage::finish(Outputs&, Context& context) {
  if (!painter_) throw Error("there is no cloud to draw");
  if (drawn_ == 0) {
    std::error_code failure;
    std::filesystem::remove(file_.string() + kProvenance, failure);
    if (std::filesystem::remove(file_, failure)) report_removed({file_}, context);
    return context.warn(file_.string() + " is not written: no point is in its view");
  }
  write_file(file_, as_png(painter_->picture()));
  context.print(fmt::format("{} points in {}", drawn_, file_.string()));
  context.wrote(file_);
}

}  // namespace crisp
