// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <crisp/context.hpp>
#include <crisp/points.hpp>
#include <crisp/stage.hpp>

namespace crisp::diagnose {

/// Stage diagnose.crispness: measures a cloud's Rényi quadratic entropy (RQE) at given kernel widths.
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

}  // namespace crisp::diagnose
