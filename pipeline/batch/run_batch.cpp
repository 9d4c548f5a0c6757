// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/batch/run_batch.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <map>
#include <utility>

#include <crisp/error.hpp>

#include "pipeline/batch/job_verdict.hpp"

namespace crisp::batch {
namespace {

using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

constexpr std::chrono::seconds kGrace{5};  // for a stopped job to clean up

class Batch {
 public:
  Batch(const std::vector<DueRecording>& due, const std::filesystem::path& output,
        const std::string& settings, const BatchLimits& limits, JobLauncher& launcher,
        ManifestWriter& manifest, const BatchHooks& hooks)
      : due_(due),
        output_(output),
        settings_(settings),
        limits_(limits),
        launcher_(launcher),
        manifest_(manifest),
        hooks_(hooks) {
    outcome_.progress.total = due.size();
  }

  BatchOutcome run() {
    while (!is_over()) {
      while (may_start()) start(due_[next_++]);
      wait();
      end_overdue();
      report_progress();
    }
    manifest_.sync();
    return std::move(outcome_);
  }

 private:
  struct Running {
    const DueRecording* recording = nullptr;
    std::vector<InputFile> files;
    Clock::time_point began;
    std::optional<Clock::time_point> end_requested;
    bool timed_out = false;
  };

  bool is_stopping() const {
    return (hooks_.stop && *hooks_.stop) || (hooks_.is_lost && hooks_.is_lost()) ||
           !outcome_.full_disk.empty();
  }
  bool is_over() const { return running_.empty() && (is_stopping() || next_ == due_.size()); }

  bool may_start() const { return !is_stopping() && next_ < due_.size() && running_.size() < most_at_once(); }

  /// By memory one job runs alone until the first has shown what it takes.
  std::size_t most_at_once() const {
    if (!limits_.memory) return limits_.jobs;
    if (largest_ == 0) return 1;
    return std::clamp<std::size_t>(*limits_.memory / largest_, 1, limits_.jobs);
  }

  void start(const DueRecording& recording) {
    Running running{.recording = &recording, .files = {}, .began = Clock::now()};
    try {
      running.files = input_files(recording.input, recording.rig);
    } catch (const Error& error) {
      return keep(recording, refused_input(error));
    }
    const Job job{.id = next_,
                  .name = recording.input.name,
                  .input = recording.input.path,
                  .output = output_ / recording.input.name,
                  .rig = recording.rig};
    remove_summary(job.output);
    if (!write(BatchEventKind::start, {{"name", job.name}})) return;
    launcher_.start(job);
    running_.emplace(job.id, std::move(running));
  }

  void wait() {
    constexpr std::chrono::milliseconds kPollEvery{100};
    auto end = launcher_.wait(running_.empty() ? std::chrono::milliseconds(0) : kPollEvery);
    for (; end; end = launcher_.wait(std::chrono::milliseconds(0))) take(*end);
    sync();
  }

  void take(const JobEnd& end) {
    const auto node = running_.extract(end.id);
    if (node.empty()) return;
    const Running& running = node.mapped();
    const DueRecording& recording = *running.recording;
    largest_ = std::max(largest_, end.memory);
    const JobCircumstances circumstances{.timeout = running.timed_out ? limits_.timeout : std::nullopt,
                                         .stopping = is_stopping()};
    const auto verdict =
        judge_job(end, circumstances, recording, running.files, output_ / recording.input.name);
    if (!verdict.full_disk.empty() && outcome_.full_disk.empty()) outcome_.full_disk = verdict.full_disk;
    keep(recording, verdict);
  }

  void keep(const DueRecording& recording, const JobVerdict& verdict) {
    Json event = {
        {"name", recording.input.name}, {"status", name_of(verdict.status)}, {"settings", settings_}};
    event.update(verdict.event);
    if (!write(BatchEventKind::end, event)) return;
    BatchProgress& progress = outcome_.progress;
    if (verdict.status == JobStatus::done) ++progress.done;
    if (verdict.status == JobStatus::untrusted) ++progress.untrusted;
    if (verdict.failure.empty() || is_stopping()) return;
    ++progress.failed;
    if (hooks_.log) hooks_.log(recording.input.name + ": " + verdict.failure);
  }

  /// @return false if the disk is full, which ends the batch
  bool write(BatchEventKind kind, const Json& event) {
    return guard_disk([&] { manifest_.append(kind, event); });
  }
  void sync() {
    guard_disk([&] { manifest_.sync(); });
  }
  template <class Action>
  bool guard_disk(Action action) {
    try {
      action();
      return true;
    } catch (const Error& error) {
      if (!is_disk_full_error(error.what())) throw;
      if (outcome_.full_disk.empty()) outcome_.full_disk = error.what();
      return false;
    }
  }

  void end_overdue() {
    const auto now = Clock::now();
    for (auto& [id, running] : running_) {
      const bool overdue =
          limits_.timeout && std::chrono::duration<double>(now - running.began).count() > *limits_.timeout;
      if (!running.end_requested && (overdue || is_stopping())) {
        running.end_requested = now;
        running.timed_out = overdue;
        launcher_.signal(id, SIGTERM);
      } else if (running.end_requested && now - *running.end_requested > kGrace) {
        launcher_.signal(id, SIGKILL);
      }
    }
  }

  void report_progress() {
    outcome_.progress.running = running_.size();
    if (hooks_.progress) hooks_.progress(outcome_.progress);
  }

  const std::vector<DueRecording>& due_;
  const std::filesystem::path& output_;
  const std::string& settings_;
  const BatchLimits& limits_;
  JobLauncher& launcher_;
  ManifestWriter& manifest_;
  const BatchHooks& hooks_;
  std::size_t next_ = 0;                      ///< of those that are due
  std::map<std::uint64_t, Running> running_;  ///< by the job's id
  std::uint64_t largest_ = 0;                 ///< [bytes] memory that a job took
  BatchOutcome outcome_;
};

}  // namespace

BatchOutcome run_batch(const std::vector<DueRecording>& due, const std::filesystem::path& output,
                       const std::string& settings, const BatchLimits& limits, JobLauncher& launcher,
                       ManifestWriter& manifest, const BatchHooks& hooks) {
  return Batch(due, output, settings, limits, launcher, manifest, hooks).run();
}

}  // namespace crisp::batch
