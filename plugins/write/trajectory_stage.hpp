// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>

#include <crisp/atomic_file.hpp>
#include <crisp/context.hpp>
#include <crisp/plate_trajectory.hpp>
#include <crisp/stage.hpp>

namespace crisp::write {

/// `write.trajectory`: how the plate turned, as a table.
class WriteTrajectoryStage final : public Stage {
 public:
  static void describe(StageDescription<WriteTrajectoryStage>& d);
  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  std::filesystem::path path_;
  std::optional<AtomicFile> file_;
  std::size_t readings_ = 0;
};

}  // namespace crisp::write
