// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>

#include <crisp/context.hpp>
#include <crisp/stage.hpp>

#include "grabbers/bag/bag_file.hpp"
#include "grabbers/bag/bag_items.hpp"
#include "grabbers/bag/bag_routes.hpp"
#include "grabbers/table/table_items.hpp"

namespace crisp::bag {

/// `grabber.bag`: scans and angles of the plate from a bag of ROS 1 or ROS 2.
class BagStage final : public Stage {
 public:
  static void describe(StageDescription<BagStage>& d);

  void check(const RunSettings& run) const override;
  void process(const Inputs& in, Outputs& out, Context& context) override;

 private:
  struct Run;
  void read(const std::filesystem::path& file, Run& run) const;
  void use(const BagRoute& route, const BagMessage& message, Run& run) const;
  static void use_points(const BagRoute& route, const PointMessage& message, Run& run);
  void report(const Run& run) const;
  bool is_requested(std::int64_t receipt_ns, Run& run) const;

  std::filesystem::path file_;
  table::ActuatorMotion actuator_ = table::ActuatorMotion::moves;
  double max_gap_ = 1;
  double begin_ = 0;
  std::optional<double> duration_;
};

}  // namespace crisp::bag
