// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/clouds_stage.hpp"

#include <fmt/format.h>

#include <system_error>

#include "pipeline/pcd/cloud_table.hpp"
#include "pipeline/pcd/parts.hpp"

namespace crisp {

void WriteCloudsStage::describe(StageDescription<WriteCloudsStage>& d) {
  d.name("write.clouds").summary("writes each cloud as a PCD file of its own, as soon as it comes");
  d.details(
      "For clouds of a live scanner, below `assemble.revolutions`: NAME_0001.pcd, NAME_0002.pcd and so on. "
      "Each "
      "file is whole from the moment at which it has its name. With `keep`, the oldest are removed, so that "
      "the "
      "disk does not fill. A disk that is full ends the writing, and the run's summary says so; the other "
      "stages "
      "go on.");
  d.takes<Cloud>();
  d.option("file", &WriteCloudsStage::file_, "where to write them, NAME.pcd").required();
  d.option("format", &WriteCloudsStage::format_, "how the points follow the header")
      .choices({{"binary_compressed", PcdFormat::binary_compressed},
                {"binary", PcdFormat::binary},
                {"ascii", PcdFormat::ascii}});
  d.option("keep", &WriteCloudsStage::keep_, "how many of the last are kept; 0: all").range(0, 1e9);
}

std::filesystem::path WriteCloudsStage::write(const Cloud& cloud) {
  AtomicFile file(part_path(file_, written_ + 1));
  write_pcd(file, to_table(cloud), format_);
  file.commit();
  return file.path();
}

void WriteCloudsStage::process(const Inputs& in, Outputs&, Context& context) {
  if (failed_) return context.count("clouds that were not written");
  try {
    kept_.push_back(write(in.get<Cloud>()));
    ++written_;
  } catch (const Error& error) {
    failed_ = true;
    context.distrust("no more clouds were written: " + error.message());
    return context.count("clouds that were not written");
  }
  if (keep_ == 0 || kept_.size() <= keep_) return;
  std::error_code ignored;
  std::filesystem::remove(kept_.front(), ignored);
  kept_.pop_front();
}

void WriteCloudsStage::finish(Outputs&, Context& context) {
  for (const auto& file : kept_) context.wrote(file);
  context.report({{"clouds", written_}});
  context.say(fmt::format("{} clouds written, {} of them kept", written_, kept_.size()));
}

}  // namespace crisp
