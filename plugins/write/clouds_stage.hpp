// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include <crisp/cloud.hpp>
#include <crisp/context.hpp>
#include <crisp/error.hpp>
#include <crisp/pcd_table.hpp>
#include <crisp/stage.hpp>

#include "pipeline/data/batcher.hpp"

namespace crisp::write {

/// `write.clouds`: each cloud as a PCD file of its own, as soon as it comes. A thread of its own writes, so
/// that the scans behind a cloud do not wait for the disk.
class WriteCloudsStage final : public Stage {
 public:
  static void describe(StageDescription<WriteCloudsStage>& d);
  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  using Clouds = std::vector<std::shared_ptr<const Cloud>>;
  void write(const Cloud& cloud);
  void fail(const Error& error, Context& context);

  std::filesystem::path file_;
  PcdFormat format_ = PcdFormat::binary_compressed;
  std::size_t keep_ = 0;
  std::uint64_t given_ = 0;
  bool failed_ = false;

  // owned by the writing thread until it has finished
  std::uint64_t written_ = 0;
  std::deque<std::filesystem::path> kept_;
  std::optional<data::Batcher<std::shared_ptr<const Cloud>>> writer_;
};

}  // namespace crisp::write
