// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/picture/picture_stage.hpp"

#include <fmt/format.h>

#include <crisp/atomic_file.hpp>

#include "plugins/write/parts_options.hpp"
#include "plugins/write/picture/painter.hpp"

namespace crisp::write {

void WritePictureStage::describe(StageDescription<WritePictureStage>& d) {
  using Settings = PictureSettings;
  d.name("write.picture").summary("draws the cloud as a PNG picture");
  d.details(
      "Coloured by laser, a pixel's light is the sum of the lasers that hit it, with brightness by the number of points: disagreement between lasers shows as seams of colour, agreement as white. Coloured by height, remission or time, a pixel has the colour of the mean, from dark blue (the 1st percentile) to yellow (the 99th). Colours are those of the report's page. A bar shows the scale; in perspective it holds at the distance of the view's centre.");
  d.takes<Cloud>();
  d.option("file", &WritePictureStage::file_, "output file, NAME.png").writes().ending(".png").required();
  d.option("view", &WritePictureStage::settings_, &Settings::view,
           "view: top (x to the right, y upwards), front (x, z), side (y, z), or perspective")
      .choices({{"top", PictureView::top},
                {"front", PictureView::front},
                {"side", PictureView::side},
                {"perspective", PictureView::perspective}});
  d.option("colour", &WritePictureStage::settings_, &Settings::colour, "quantity that the colour shows")
      .choices({{"laser", PictureColour::laser},
                {"height", PictureColour::height},
                {"remission", PictureColour::remission},
                {"time", PictureColour::time}});
  d.option(
       "depth", &WritePictureStage::depth_,
       "limits of the drawn points: heights for top and perspective, y for front, x for side; none: all points")
      .unit("m")
      .count(0, 2);
  d.option("across", &WritePictureStage::settings_, &Settings::across,
           "width of the view from edge to edge; auto: a round number that holds 98 % of the points")
      .unit("m")
      .range(1e-3, 1e6);
  d.option("centre", &WritePictureStage::centre_,
           "centre of the view, to the right and upwards; none: that of the points")
      .unit("m")
      .count(0, 2);
  d.option("azimuth", &WritePictureStage::settings_, &Settings::azimuth,
           "perspective: direction of the eye from the centre, from +x towards +y")
      .unit("rad");
  d.option("elevation", &WritePictureStage::settings_, &Settings::elevation,
           "perspective: angle of the eye above the plate's plane")
      .unit("rad")
      .range(-1.5707963267948966, 1.5707963267948966);
  d.option("width", &WritePictureStage::settings_, &Settings::width, "width in pixels").range(1, 20000);
  d.option("height", &WritePictureStage::settings_, &Settings::height, "height in pixels").range(1, 20000);
}

void WritePictureStage::check(const RunSettings&) const {
  if (depth_.size() == 1 || (depth_.size() == 2 && depth_[0] >= depth_[1])) {
    throw Error("the depth needs two limits, the lower one first", "for instance depth: [0.5m, 1.5m]");
  }
  if (centre_.size() == 1) {
    throw Error("the centre needs two coordinates", "for instance centre: [0m, 1.5m]: to the right, upwards");
  }
}

PictureSettings WritePictureStage::effective_settings() const {
  PictureSettings settings = settings_;
  if (centre_.size() == 2) settings.centre = {centre_[0], centre_[1]};
  if (depth_.size() == 2) settings.depth = {depth_[0], depth_[1]};
  return settings;
}

void WritePictureStage::process(const Inputs& in, Outputs&, Context&) {
  if (!points_) points_.emplace(settings_.colour);
  points_->add(in.get<Cloud>());
}

void WritePictureStage::finish(Outputs&, Context& context) {
  if (!points_) throw Error("there is no cloud to draw", "put a stage above it that gives a cloud");
  const Picture picture = paint(*points_, effective_settings());
  if (picture.drawn == 0) {
    std::error_code failure;
    std::filesystem::remove(file_.string() + kProvenance, failure);
    if (std::filesystem::remove(file_, failure)) report_removed({file_}, context);
    return context.warn(file_.string() + " is not written: no point is in its view");
  }
  write_file(file_, as_png(picture));
  context.print(fmt::format("{} points in {}", picture.drawn, file_.string()));
  context.wrote(file_);
}

}  // namespace crisp::write
