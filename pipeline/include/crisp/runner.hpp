// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <crisp/context.hpp>
#include <crisp/error.hpp>
#include <crisp/pipeline.hpp>

namespace crisp {

/// Result of one stage of a run.
struct NodeResult {
  std::string tag;                             ///< of the stage in the pipeline
  std::string stage;                           ///< its name: "calibrate.rqe"
  double seconds = 0;                          ///< its own time, without that of the stages that it feeds
  std::map<std::string, std::uint64_t> taken;  ///< items by kind
  std::map<std::string, std::uint64_t> given;  ///< items by kind
  StageReport report;                          ///< what the stage reported
};

/// Hooks to stop and watch a run from outside.
struct RunHooks {
  /// Becomes true when the run is to stop; nullptr: nobody stops it.
  const std::atomic<bool>* stop = nullptr;
  /// Called with the progress that a stage reports.
  std::function<void(const std::string& tag, const Progress& progress)> progress = {};
  /// Called with the status that a stage sets.
  std::function<void(const std::string& tag, const StageStatus& status)> status = {};
  /// Called with each caveat once the call in which a stage gave it has ended; a stage below may resolve it.
  std::function<void(const std::string& tag, const std::string& caveat)> caveat = {};
  /// Called with each item before it runs through the stages below.
  std::function<void(const std::string& tag, const Item& item)> given = {};
  /// The stages' results up to a failure or a stop request; called before run_pipeline throws.
  std::function<void(std::vector<NodeResult> until_then)> failed = {};
};

/// Runs a pipeline to its end in the calling thread: each source gives all that it has, every item runs
/// through all stages below before the next is given (depth first, in the pipeline's order, without queues),
/// then each stage finishes, in the pipeline's order. The same pipeline always runs in the same order.
///
/// A source all of whose items are held by others runs before the other sources, so that a known calibration
/// is there before the data.
/// Where a source is endless, a stop request ends that source alone, and the run comes to its end.
/// Several endless sources run at the same time, each in a thread of its own, after the others; what they
/// give takes turns, so that no stage below is ever called twice at the same time. One that fails ends the
/// others.
/// @throws Error        what a stage threw, with the stage's tag, and its place in the pipeline's file
/// @throws Interrupted  on a stop request; no stage has finished then that had not before
std::vector<NodeResult> run_pipeline(Pipeline& pipeline, const RunSettings& run, const RunHooks& hooks = {});

}  // namespace crisp
