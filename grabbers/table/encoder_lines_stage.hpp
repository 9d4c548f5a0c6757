// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <istream>
#include <optional>

#include <crisp/context.hpp>
#include <crisp/stage.hpp>

#include "grabbers/table/encoder_lines.hpp"
#include "pipeline/files/byte_stream.hpp"

namespace crisp::table {

/// `grabber.encoder_lines`: encoder readings from a file of the lines that an encoder sent, among scans in
/// the order of their receipt.
class EncoderLinesStage final : public Stage {
 public:
  static void describe(StageDescription<EncoderLinesStage>& d);

  void check(const RunSettings& run) const override;
  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  /// The file while it is read.
  struct File {
    File(const std::filesystem::path& file, const Rig& rig, std::optional<TimeUnit> stamp_unit);

    files::ByteStream stream;
    files::ByteStreamBuffer buffer;
    std::istream in;
    EncoderLines lines;
    std::optional<PlateReading> next;  ///< reading that was not given yet
  };
  /// Gives the readings that were received until then [ns].
  void give_until(std::int64_t receipt_ns, Outputs& out, Context& context);
  void report(Context& context) const;

  std::filesystem::path path_;
  std::optional<TimeUnit> stamp_unit_;
  std::optional<File> file_;
};

}  // namespace crisp::table
