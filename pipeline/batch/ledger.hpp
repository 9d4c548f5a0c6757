// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "pipeline/batch/manifest.hpp"

namespace crisp {

/// What the manifests say of one recording.
struct RecordingState {
  std::string started = {};      ///< time of the last `start`; empty: none
  std::string ended = {};        ///< time of the last `end`; empty: none
  std::string retry_asked = {};  ///< time of the last `retry`; empty: none
  JobStatus status = JobStatus::interrupted;
  std::string settings = {};
  std::vector<InputFile> input = {};
  std::filesystem::path started_by = {};  ///< folder of the task of the last `start`

  bool has_ended() const { return !ended.empty(); }
  bool is_half_done() const { return started > ended; }
  bool is_retry_asked() const { return retry_asked > ended; }
};

/// Why a recording is to be processed.
enum class DueReason { none, fresh, half_done, interrupted, retry, settings, input };

/// The events of all manifests of a batch, folded by recording: the last one counts, whichever task wrote it.
class BatchLedger {
 public:
  /// Reads all manifests of an output folder.
  /// @param wanted  the recordings to keep; empty: all
  /// @throws Error if one cannot be read
  static BatchLedger read(const std::filesystem::path& output,
                          const std::function<bool(std::string_view name)>& wanted = {});

  /// @param task  folder of the task whose event it is
  void add(BatchEvent event, const std::filesystem::path& task);

  /// nullptr: no event speaks of it.
  const RecordingState* find(const std::string& name) const;
  const std::unordered_map<std::string, RecordingState>& all() const { return states_; }
  std::size_t damaged_lines() const { return damaged_lines_; }

 private:
  std::unordered_map<std::string, RecordingState> states_;
  std::size_t damaged_lines_ = 0;
};

/// Why a recording is due by what is known of it, its input's content left aside.
/// @param settings  digest of what it would be processed with
DueReason due_reason(const RecordingState* state, const std::string& settings);

}  // namespace crisp
