// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include <crisp/cloud.hpp>
#include <crisp/context.hpp>
#include <crisp/error.hpp>

#include "example.hpp"

namespace {

/// Drops the points that are far from the spin axis.
class NearStage final : public crisp::Stage {
 public:
  static void describe(crisp::StageDescription<NearStage>& d) {
    d.name("example.near").summary("drops the points that are far from the spin axis");
    d.takes<crisp::Cloud>().gives<crisp::Cloud>();
    d.option("radius", &NearStage::radius_, "largest distance from the axis that is kept")
        .unit("m")
        .range(0, 1000);
    d.option("inner", &NearStage::inner_, "smallest distance from the axis that is kept")
        .unit("m")
        .range(0, 1000);
  }

  void check(const crisp::RunSettings&) const override {
    crisp::check_all(crisp::of_option("inner", [&] {
      if (inner_ >= radius_)
        throw crisp::Error("inner is not below radius: no point is kept", "give a smaller one");
    }));
  }

  void process(const crisp::Inputs& in, crisp::Outputs& out, crisp::Context& context) override {
    const auto& cloud = in.get<crisp::Cloud>();
    crisp::Cloud near;
    near.header = cloud.header;
    for (const auto& point : cloud) {
      const double distance = std::hypot(static_cast<double>(point.x), static_cast<double>(point.y));
      if (distance >= inner_ && distance <= radius_) near.push_back(point);
    }
    context.count("points that are not near", cloud.size() - near.size());
    out.give(std::move(near));
  }

 private:
  double radius_ = 10;
  double inner_ = 0;
};

}  // namespace

void register_near_stage(crisp::Registrar& registrar) { registrar.stage<NearStage>(); }
