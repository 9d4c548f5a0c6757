// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/batch/input_state.hpp"

namespace crisp::batch {

/// Kinds of events in a batch. docs/how-to/batch.md has the schema of the lines.
enum class BatchEventKind {
  batch,  ///< a batch begins
  start,  ///< a job begins
  end,    ///< a job ended
  same,   ///< an input has another time but the same content
  retry   ///< a recording is to be processed again
};

/// Status of a recording's last job.
enum class JobStatus {
  done,        ///< and its result can be trusted
  untrusted,   ///< it came to its end, but its result cannot be trusted
  failed,      ///< it failed by itself: the same again would fail the same way
  interrupted  ///< it was stopped or killed from outside: it is due again
};

std::string_view name_of(JobStatus status);

/// One line of a manifest, without what only a table needs.
struct BatchEvent {
  BatchEventKind kind = BatchEventKind::start;
  std::int64_t time = 0;  ///< [ms since the Unix epoch]
  std::string name;       ///< of the recording; empty: of the batch
  JobStatus status = JobStatus::done;
  std::string settings;          ///< digest of what it was processed with
  std::vector<InputFile> input;  ///< what it was processed of
};

/// Appends events to a file: each is one line, written by one call, and on the disk when sync() returns.
class ManifestWriter {
 public:
  /// Opens or makes the file. What stands behind its last line end was cut off by the end of a process, and
  /// is removed.
  /// @throws Error if it cannot be written
  explicit ManifestWriter(std::filesystem::path file);
  ~ManifestWriter();
  ManifestWriter(const ManifestWriter&) = delete;
  ManifestWriter& operator=(const ManifestWriter&) = delete;

  /// Adds `event` and `time` to the event, and writes it.
  /// @throws Error that names the file; nothing of the line remains then
  void append(BatchEventKind kind, const nlohmann::ordered_json& event);
  /// @throws Error that names the file
  void sync();

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
  bool is_synced_ = true;
};

/// Reads the events of a file, in their order. A last line without its end is passed over: it is being
/// written.
/// @param use  is called with each event, and with its whole line, of which it is a part
/// @return how many lines are no events, which a failure of the disk leaves: they are passed over
/// @throws Error that names the file, if it cannot be read
std::size_t read_manifest(const std::filesystem::path& file,
                          const std::function<void(BatchEvent&& event, std::string_view line)>& use);

inline constexpr const char* kManifestFile = "events.jsonl";

/// The folder of a task, in which it has its manifest, and a lock while it runs: "batch", or "shard-3-of-64".
std::filesystem::path task_folder(const std::filesystem::path& output, const std::string& task);

/// The manifests of all tasks, sorted by name.
/// @throws Error if the folder cannot be read
std::vector<std::filesystem::path> manifests_of(const std::filesystem::path& output);

/// An event's record of its input files.
nlohmann::ordered_json to_json(const std::vector<InputFile>& files);

}  // namespace crisp::batch
