// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/clouds_stage.hpp"

#include <fmt/format.h>

#include <system_error>

#include <crisp/cloud_conversion.hpp>

#include "pipeline/pcd/parts.hpp"
#include "plugins/write/parts_options.hpp"

namespace crisp::write {
namespace {

/// In the header of each: which one it is.
const std::string kCloud = "cloud";

}  // namespace

void WriteCloudsStage::describe(StageDescription<WriteCloudsStage>& d) {
  d.name("write.clouds").summary("writes each cloud as a PCD file of its own, as soon as it is complete");
  d.details(
      "For clouds of a live scanner, below `assemble.revolutions`: NAME_0001.pcd, NAME_0002.pcd and so on. Each file is complete from the moment it has its name. Higher-numbered files of an earlier run are removed at the end. With `keep`, the oldest are removed, which bounds the disk space. A full disk ends the writing, which the summary reports; the other stages go on. A thread of its own writes; while two clouds wait for the disk, a third one blocks the stages above.");
  d.takes<Cloud>();
  d.option("file", &WriteCloudsStage::file_, "output files, NAME.pcd")
      .writes({"<stem>_####<ext>"})
      .ending(".pcd")
      .required();
  d.option("format", &WriteCloudsStage::format_, "encoding of the points")
      .choices({{"binary_compressed", PcdFormat::binary_compressed},
                {"binary", PcdFormat::binary},
                {"ascii", PcdFormat::ascii}});
  d.option("keep", &WriteCloudsStage::keep_, "number of latest clouds to keep; 0: all").range(0, 1e9);
}

void WriteCloudsStage::write(const Cloud& cloud) {
  AtomicFile file(pcd::part_path(file_, written_ + 1));
  PcdTable table = to_pcd_table(cloud);
  table.set_note(kCloud, std::to_string(written_ + 1));
  write_pcd(file, table, format_);
  file.commit();
  kept_.push_back(file.path());
  ++written_;
  if (keep_ == 0 || kept_.size() <= keep_) return;
  std::error_code ignored;
  std::filesystem::remove(kept_.front(), ignored);
  kept_.pop_front();
}

void WriteCloudsStage::process(const Inputs& in, Outputs&, Context& context) {
  ++given_;
  if (failed_) return;
  if (!writer_) {
    writer_.emplace(data::BatchSettings{}, [this](const Clouds& clouds) {
      for (const auto& cloud : clouds) write(*cloud);
    });
  }
  try {
    writer_->push(in.share<Cloud>());
  } catch (const Error& error) {
    fail(error, context);
  }
}

void WriteCloudsStage::fail(const Error& error, Context& context) {
  failed_ = true;
  const std::string what = "no more clouds were written: " + error.message();
  context.mark_untrusted(what);
  context.set_status({.line = "no more clouds are written", .events = {what}});
}

void WriteCloudsStage::finish(Outputs&, Context& context) {
  try {
    if (writer_ && !failed_) writer_->drain();
  } catch (const Error& error) {
    fail(error, context);
  }
  writer_.reset();
  context.count("lost clouds (not written)", given_ - written_);
  for (const auto& file : kept_) context.wrote(file);
  if (written_ > 0) report_removed(pcd::remove_numbered_beyond(file_, written_, kCloud), context);
  context.report({{"clouds", written_}});
  context.print(fmt::format("{} clouds written, {} of them kept", written_, kept_.size()));
}

}  // namespace crisp::write
