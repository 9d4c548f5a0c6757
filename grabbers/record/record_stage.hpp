// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <crisp/context.hpp>
#include <crisp/error.hpp>
#include <crisp/registrar.hpp>
#include <crisp/stage.hpp>

#include "grabbers/record/capture_recorder.hpp"

namespace crisp::record {

/// `write.capture`: records what was received, for `grabber.capture`.
class RecordStage final : public Stage {
 public:
  static void describe(StageDescription<RecordStage>& d);

  void check(const RunSettings& run) const override;
  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  void write(HubItem item, Context& context);
  void fail(const Error& error, Context& context);
  void end();

  std::filesystem::path file_;
  RecorderSettings settings_;
  std::unique_ptr<CaptureRecorder> recorder_;
  bool failed_ = false;
  std::uint64_t given_ = 0;                   ///< items
  std::uint64_t recorded_ = 0;                ///< of them, once it has ended
  std::vector<std::filesystem::path> files_;  ///< likewise
  std::vector<std::string> notes_;            ///< likewise
};

/// The recorder's stage.
void register_record(Registrar& registrar);

}  // namespace crisp::record
