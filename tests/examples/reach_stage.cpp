// SPDX-License-Identifier: BSD-3-Clause
#include <crisp/context.hpp>
#include <crisp/measurements.hpp>

#include "example.hpp"

namespace {

/// Drops the beams that are longer than a limit.
class ReachStage final : public crisp::Stage {
 public:
  static void describe(crisp::StageDescription<ReachStage>& d) {
    d.name("example.reach").summary("drops the beams that are longer than a limit");
    d.takes<crisp::Measurements>().gives<crisp::Measurements>();
    d.option("limit", &ReachStage::limit_, "largest range that is kept").unit("m").range(0, 1000);
  }

  void process(const crisp::Inputs& in, crisp::Outputs& out, crisp::Context& context) override {
    const auto& all = in.get<crisp::Measurements>();
    crisp::Measurements kept;
    kept.epoch_ns = all.epoch_ns;  // append() of one beam leaves it
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (static_cast<double>(all.range[i]) <= limit_) kept.append(all, i);
    }
    context.count("measurements beyond the limit", all.size() - kept.size());
    out.give(std::move(kept));
  }

 private:
  double limit_ = 10;
};

}  // namespace

void register_reach_stage(crisp::Registrar& registrar) { registrar.stage<ReachStage>(); }
