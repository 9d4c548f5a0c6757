// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/assemble/revolutions_stage.hpp"

#include <fmt/format.h>

namespace crisp {

void RevolutionsStage::describe(StageDescription<RevolutionsStage>& d) {
  d.name("assemble.revolutions").summary("gathers the points of single scans into one cloud a revolution");
  d.details(
      "A cloud ends when the plate has turned so far from where the cloud began, forwards or back, or after "
      "`longest`: the split is at the point, not at the scan. Each cloud is given as soon as all lasers have "
      "gone "
      "on to the next. What came at last, an unfinished revolution, is given at the end.");
  d.takes<Cloud>().holds<PlateTrajectory>().gives<Cloud>();
  d.option("turns", &RevolutionsStage::settings_, &RevolutionSettings::turns,
           "of the plate in one cloud: 0.5 is a half")
      .range(0.01, 1000);
  d.option("longest", &RevolutionsStage::settings_, &RevolutionSettings::longest,
           "time in one cloud, where the plate does not turn so far")
      .unit("s")
      .range(0.01, 3600);
}

void RevolutionsStage::process(const Inputs& in, Outputs& out, Context&) {
  out_ = &out;
  if (!revolutions_) {
    revolutions_.emplace(settings_, [this](std::shared_ptr<const Cloud> cloud) {
      ++clouds_;
      out_->give(std::move(cloud));
    });
  }
  revolutions_->add(in.get<Cloud>(), in.get<PlateTrajectory>());
}

void RevolutionsStage::finish(Outputs& out, Context& context) {
  out_ = &out;
  if (revolutions_) revolutions_->finish();
  context.report({{"clouds", clouds_}});
  context.say(fmt::format("{} clouds of {:g} turns", clouds_, settings_.turns));
}

}  // namespace crisp
