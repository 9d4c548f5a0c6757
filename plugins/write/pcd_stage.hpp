// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <crisp/cloud.hpp>

#include "plugins/write/parts_options.hpp"
#include "plugins/write/recording_borders.hpp"

namespace crisp::write {

/// `write.pcd`: all clouds that come, as one, in a PCD file, or in several where it is long.
class WritePcdStage final : public Stage {
 public:
  static void describe(StageDescription<WritePcdStage>& d);
  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  void add(const Point& point);

  PartsOptions options_;
  std::optional<pcd::PartsWriter> writer_;
  Cloud pending_;
  RecordingBorders borders_;
  std::size_t recording_ = 0;  ///< of what is pending
  std::size_t written_ = 0;
};

}  // namespace crisp::write
