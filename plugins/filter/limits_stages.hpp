// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <crisp/context.hpp>
#include <crisp/stage.hpp>

#include "plugins/filter/limits.hpp"

namespace crisp::filter {

/// `filter.crop`: a part of the cloud, by where its points are.
class CropStage final : public Stage {
 public:
  static void describe(StageDescription<CropStage>& d);
  void check(const RunSettings& run) const override;
  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  CropLimits limits_;
  std::size_t all_ = 0;
  std::size_t kept_ = 0;
};

/// `filter.range`: some of the measurements, by what was measured.
class RangeStage final : public Stage {
 public:
  static void describe(StageDescription<RangeStage>& d);
  void check(const RunSettings& run) const override;
  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  RangeLimits limits(const Rig& rig) const;

  Limits range_;
  Limits mirror_angle_;
  Limits remission_;
  std::vector<std::string> lasers_;
  std::size_t all_ = 0;
  std::size_t kept_ = 0;
};

}  // namespace crisp::filter
