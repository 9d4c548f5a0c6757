// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>

#include <crisp/runner.hpp>

#include "pipeline/app/commands.hpp"
#include "pipeline/app/run_record.hpp"
#include "pipeline/files/folder_lock.hpp"

namespace crisp::app {

/// One run of a pipeline, and its records: summary.json in the output folder, and a provenance record next to
/// each file that a stage writes. The output folder is locked while this object lives.
class RecordedRun {
 public:
  /// Loads the pipeline and locks the output folder.
  /// @throws Errors  all that is wrong with the pipeline, the rig or the command line; nothing was run
  RecordedRun(const RunRequest& request, const Registrar& registrar);

  const Pipeline& pipeline() const { return loaded_.pipeline; }
  const RunSettings& settings() const { return settings_; }
  RunRecord& record() { return record_; }

  /// Runs the pipeline, which is gone afterwards, and with it what is left of files that are not complete: on
  /// a full disk the records need the room.
  /// @param hooks  `failed` is the record's
  /// @throws Error, Interrupted  as run_pipeline does
  void run(RunHooks hooks);

  /// Writes the records. Each part is tried even if another one failed: a summary without the rest is still
  /// useful.
  /// @param report  called with what could not be written
  /// @return whether all of it was written
  bool keep(const std::function<void(const Error&)>& report);

 private:
  bool has_lost_folder(const std::function<void(const Error&)>& report) const;

  RunSettings settings_;
  LoadedPipeline loaded_;
  std::unique_ptr<files::FolderLock> lock_;
  RunRecord record_;
};

}  // namespace crisp::app
