// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/batch/job_verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>

#include "pipeline/files/folder_lock.hpp"

namespace crisp::batch {
namespace {

using Json = nlohmann::ordered_json;

/// Exit statuses of `crisp run` that was stopped by SIGHUP, SIGINT or SIGTERM.
bool is_interrupted(int exit_status) {
  constexpr std::array kInterrupted = {129, 130, 143};
  return std::ranges::find(kInterrupted, exit_status) != kInterrupted.end();
}

/// Signals that come from people and from a system without memory, not from a mistake in the program.
bool comes_from_outside(int signal) {
  constexpr std::array kOutside = {SIGHUP, SIGINT, SIGTERM, SIGKILL};
  return std::ranges::find(kOutside, signal) != kOutside.end();
}

std::string trimmed(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  return text;
}

std::string failure_by_signal(const JobEnd& end) {
  std::string text = fmt::format("it was killed by signal {} ({})", end.signal, strsignal(end.signal));
  if (end.signal == SIGKILL)
    text += "; if the machine lacked memory, limit it with --memory or run fewer --jobs";
  else if (!comes_from_outside(end.signal))
    text += "; run it alone with crisp run to locate the cause";
  const std::string printed = trimmed(end.error);
  return printed.empty() ? text : text + "; before it printed: " + printed;
}

void judge(const JobEnd& end, const JobCircumstances& circumstances, const Json& results,
           JobVerdict& verdict) {
  constexpr int kRefused = 2;  // before anything ran
  const bool was_ended = comes_from_outside(end.signal) || is_interrupted(end.exit_status);
  if (circumstances.timeout && was_ended) {
    verdict.status = JobStatus::failed;
    verdict.failure =
        fmt::format("it exceeded {:g} s and was killed; raise --timeout or omit it", *circumstances.timeout);
  } else if (circumstances.stopping && was_ended) {
    verdict.status = JobStatus::interrupted;
    verdict.failure = "the batch was stopped";
  } else if (end.signal != 0) {
    verdict.status = comes_from_outside(end.signal) ? JobStatus::interrupted : JobStatus::failed;
    verdict.failure = failure_by_signal(end);
  } else if (is_interrupted(end.exit_status)) {
    verdict.status = JobStatus::interrupted;
    verdict.failure = fmt::format("it was killed from outside by signal {}", end.exit_status - 128);
  } else if (end.exit_status == kRefused && files::FolderLock::is_refusal(end.error)) {
    verdict.status = JobStatus::interrupted;
    verdict.failure = trimmed(end.error);
  } else if (end.exit_status == 3) {
    verdict.status = JobStatus::untrusted;
  } else if (end.exit_status != 0) {
    verdict.status = JobStatus::failed;
    verdict.failure = results.contains("error") ? results["error"].get<std::string>() : trimmed(end.error);
    if (verdict.failure.empty())
      verdict.failure = fmt::format("it exited with status {} and without a message", end.exit_status);
  }
}

/// On a full disk a run may fail, or it may end and report that some files were not written.
void judge_disk(const Json& results, JobVerdict& verdict) {
  std::vector<std::string> messages = {verdict.failure};
  for (const auto& reason : results.value("reasons", Json::array())) messages.push_back(reason);
  const auto full = std::ranges::find_if(messages, is_disk_full_error);
  if (verdict.status == JobStatus::done || full == messages.end()) return;
  verdict.full_disk = *full;
  verdict.failure = *full;
  verdict.status = JobStatus::interrupted;
}

/// The read input differs from the present one, or changed meanwhile.
void judge_input(const DueRecording& recording, const std::vector<InputFile>& files, JobVerdict& verdict) {
  std::string change;
  try {
    if (!is_untouched(files, input_files(recording.input, recording.rig))) change = "it changed";
  } catch (const Error& error) {
    change = error.what();
  }
  if (change.empty()) return;
  verdict.status = JobStatus::interrupted;
  verdict.failure = "the input changed during the job: " + change + "; run the batch again";
}

/// The files with the content that the job saw.
Json input_json(const DueRecording& recording, std::vector<InputFile> files,
                const std::map<std::string, std::string>& sha256) {
  for (const auto& [path, digest] : sha256) {
    const std::filesystem::path read(path);
    const bool own =
        read == recording.input.path || read.parent_path() == recording.input.path || read == recording.rig;
    const auto file = std::ranges::find(files, read.filename().string(), &InputFile::file);
    if (own && file != files.end()) file->sha256 = digest;
  }
  return to_json(files);
}

}  // namespace

bool is_disk_full_error(std::string_view message) {
  return std::ranges::any_of(std::array{ENOSPC, EDQUOT}, [&](int code) {
    return message.find(std::strerror(code)) != std::string_view::npos;
  });
}

JobVerdict judge_job(const JobEnd& end, const JobCircumstances& circumstances, const DueRecording& recording,
                     const std::vector<InputFile>& files, const std::filesystem::path& output) {
  JobVerdict verdict;
  JobResults results = read_results(output);
  judge(end, circumstances, results.json, verdict);
  judge_disk(results.json, verdict);
  if (verdict.status != JobStatus::interrupted) judge_input(recording, files, verdict);
  if (!verdict.failure.empty()) results.json["error"] = verdict.failure;
  verdict.event = {{"input", input_json(recording, files, results.sha256)},
                   {"exit", end.exit_status},
                   {"signal", end.signal},
                   {"seconds", end.seconds},
                   {"cpu", end.cpu_seconds},
                   {"memory", end.memory},
                   {"results", std::move(results.json)}};
  return verdict;
}

JobVerdict refused_input(const Error& error) {
  JobVerdict verdict{.status = JobStatus::failed, .failure = error.what()};
  verdict.event = {{"results", {{"error", error.what()}}}};
  return verdict;
}

}  // namespace crisp::batch
