// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "pipeline/quality/points.hpp"
#include "pipeline/stage/context.hpp"
#include "pipeline/stage/description.hpp"

namespace crisp {

/// Says how crisp a cloud is: its RQE, for one kernel width or several.
class CrispnessStage final : public Stage {
 public:
  static void describe(StageDescription<CrispnessStage>& d);
  void check(const RunSettings& run) const override;
  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  std::vector<double> sigmas_{0.03};
  double cutoff_ = 7;
  std::string search_ = "grid";
  Vectors points_;
};

}  // namespace crisp
