// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "pipeline/batch/manifest.hpp"

namespace crisp::batch {

/// A recording's state by the manifests. There may be a million of them: texts that many share are views
/// of the ledger's.
struct RecordingState {
  std::int64_t started = 0;          ///< [ms since the Unix epoch] time of the last `start`; 0: none
  std::int64_t ended = 0;            ///< of the last `end`
  std::int64_t retry_requested = 0;  ///< of the last `retry`
  JobStatus status = JobStatus::interrupted;
  std::string_view settings = {};
  std::string_view started_by = {};  ///< folder of the task of the last `start`
  std::vector<InputFile> input = {};

  bool has_ended() const { return ended > 0; }
  bool is_half_done() const { return started > ended; }
  bool is_retry_requested() const { return retry_requested > ended; }
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
                          const std::function<bool(std::string_view name)>& requested = {});

  /// @param task  folder of the task whose event it is
  void add(BatchEvent event, std::string_view task);

  /// nullptr: no event speaks of it.
  const RecordingState* find(const std::string& name) const;
  const std::unordered_map<std::string, RecordingState>& all() const { return states_; }
  std::size_t damaged_lines() const { return damaged_lines_; }

 private:
  std::string_view shared(std::string_view text);

  std::unordered_map<std::string, RecordingState> states_;
  std::set<std::string, std::less<>> texts_;  ///< that states view; they stay where they are
  std::size_t damaged_lines_ = 0;
};

/// Why a recording is due by what is known of it, its input's content left aside.
/// @param settings  digest of what it would be processed with
DueReason due_reason(const RecordingState* state, const std::string& settings);

}  // namespace crisp::batch
