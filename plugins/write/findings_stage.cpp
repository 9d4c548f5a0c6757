// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/findings_stage.hpp"

#include <algorithm>

#include "pipeline/files/atomic_file.hpp"
#include "pipeline/files/findings_file.hpp"

namespace crisp {

void WriteFindingsStage::describe(StageDescription<WriteFindingsStage>& d) {
  d.name("write.findings").summary("writes what all diagnoses above it say as JSON");
  d.takes<Findings>();
  d.option("file", &WriteFindingsStage::file_, "where to write it").required();
}

void WriteFindingsStage::process(const Inputs& in, Outputs&, Context&) {
  const Findings& more = in.get<Findings>();
  const auto append = [](auto& all, const auto& these) { all.insert(all.end(), these.begin(), these.end()); };
  if (!all_) all_.emplace();
  append(all_->findings, more.findings);
  append(all_->unnamed, more.unnamed);
  append(all_->unobservable, more.unobservable);
  append(all_->devices, more.devices);
  all_->before_p = std::min(all_->before_p, more.before_p);
  all_->after_p = std::min(all_->after_p, more.after_p);
}

void WriteFindingsStage::finish(Outputs&, Context& context) {
  if (!all_) throw Error("no findings came, so none were written");
  write_file(file_, findings_json(*all_));
  context.wrote(file_);
}

}  // namespace crisp
