// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/findings_stage.hpp"

#include <crisp/atomic_file.hpp>

#include "pipeline/files/findings_file.hpp"

namespace crisp::write {

void WriteFindingsStage::describe(StageDescription<WriteFindingsStage>& d) {
  d.name("write.findings").summary("writes the findings of a diagnosis as JSON");
  d.takes<Findings>();
  d.option("file", &WriteFindingsStage::file_, "output file, NAME.json").writes().required();
}

void WriteFindingsStage::process(const Inputs& in, Outputs&, Context&) { last_ = in.share<Findings>(); }

void WriteFindingsStage::finish(Outputs&, Context& context) {
  if (!last_) throw Error("there were no findings to write", "see what the stages above report");
  write_file(file_, files::findings_json(*last_));
  context.wrote(file_);
}

}  // namespace crisp::write
