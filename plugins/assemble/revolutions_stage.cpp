// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/assemble/revolutions_stage.hpp"

#include <fmt/format.h>

namespace crisp::assemble {

void RevolutionsStage::describe(StageDescription<RevolutionsStage>& d) {
  d.name("assemble.revolutions").summary("merges the points of scans into one cloud per revolution");
  d.details(
      "A cloud ends when the plate has turned by `turns` from the cloud's begin, forwards or back, or after `max_duration`: clouds are split between points, not between scans. Each cloud is given as soon as all lasers have reached the next. The last, unfinished revolution is given at the end.");
  d.takes<Cloud>().holds<PlateTrajectory>().gives<Cloud>();
  d.option("turns", &RevolutionsStage::settings_, &RevolutionSettings::turns,
           "turns of the plate in one cloud: 0.5 is a half")
      .range(0.01, 1000);
  d.option("max_duration", &RevolutionsStage::settings_, &RevolutionSettings::longest,
           "maximum duration of one cloud, where the plate turns less")
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
  context.print(fmt::format("{} clouds of {:g} turns", clouds_, settings_.turns));
}

}  // namespace crisp::assemble
