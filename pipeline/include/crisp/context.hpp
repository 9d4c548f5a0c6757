// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include <crisp/rig.hpp>

namespace crisp {

class Registrar;

/// Progress of a stage's own work.
struct Progress {
  double done = 0;        ///< of `total`
  double total = 1;       ///< in `unit`
  std::string_view unit;  ///< "B", "points"; empty where there is no meaningful amount
  std::string_view what;  ///< current activity: "sigma 5 cm"
};
using ProgressSink = std::function<void(const Progress&)>;

/// A number that programs watch while a run goes on, in the manner of Prometheus.
struct Gauge {
  std::string name;         ///< "scans_total", "clock_skew_ppm": of small letters, digits and _
  double value = 0;         ///< in the unit that the name ends with
  std::string device = {};  ///< which it is of, if any
};

/// Status of a stage in a run without end.
struct StageStatus {
  std::string line;                      ///< for people: "laser1 50.0 Hz, laser2 50.1 Hz, plate 500 Hz"
  std::vector<Gauge> gauges = {};        ///< for programs
  std::vector<std::string> events = {};  ///< since the last status: each a line of the log
};
using StatusSink = std::function<void(const StageStatus&)>;

/// Settings of a run, the same for all of its stages.
struct RunSettings {
  Rig rig = default_rig();               ///< the scanner
  unsigned threads = 1;                  ///< how many threads a stage may use
  std::uint64_t seed = 1;                ///< for whatever is drawn at random
  std::filesystem::path output;          ///< the folder that `-o` names; empty if none was given
  const Registrar* registrar = nullptr;  ///< what is known by name: stages, and whatever else was registered
};

/// A stage's report on a run.
struct StageReport {
  std::map<std::string, std::uint64_t> counts;        ///< losses and other events, see Context::count
  std::vector<std::string> warnings;                  ///< see Context::warn
  std::vector<std::string> caveats;                   ///< see Context::mark_untrusted
  std::map<std::string, std::string> lifted;          ///< of which kind caveats no longer hold, and why
  nlohmann::json section = nlohmann::json::object();  ///< the stage's section of summary.json
  std::vector<std::string> lines;                     ///< see Context::print
  std::vector<std::filesystem::path> read;            ///< files that the results depend on
  std::vector<std::filesystem::path> written;         ///< complete files
  std::function<void(const nlohmann::ordered_json& summary)> when_recorded =
      {};  ///< see Context::when_recorded
};

/// A stage's access to its run: settings, reports and progress. To be used from the thread that calls the
/// stage; only interrupted() is thread-safe.
class Context {
 public:
  /// @param run       settings of the run; they outlive this object
  /// @param report    receives what the stage reports; outlives this object
  /// @param stop      becomes true when the run is to stop; nullptr: nobody stops it
  /// @param progress  receives the stage's progress; empty: nobody wants to know
  Context(const RunSettings& run, StageReport& report, const std::atomic<bool>* stop = nullptr,
          ProgressSink progress = {})
      : run_(&run), report_(&report), stop_(stop), progress_(std::move(progress)) {}

  /// The scanner's rig.
  const Rig& rig() const { return run_->rig; }
  /// Number of threads that the stage may use, ≥ 1.
  unsigned threads() const { return run_->threads; }
  /// Seed of whatever the stage draws at random.
  std::uint64_t seed() const { return run_->seed; }
  /// All settings of the run.
  const RunSettings& run() const { return *run_; }

  /// Adds to the loss (or other event) of this name: "telegrams with a wrong checksum". Zero makes it known.
  void count(const std::string& name, std::uint64_t n = 1) { report_->counts[name] += n; }
  /// Something that a person should know but that does not stop the run.
  void warn(std::string text) { report_->warnings.push_back(std::move(text)); }
  /// Adds a caveat: the run goes on, but its result is untrusted, the summary states why, and the exit status
  /// is not 0.
  void mark_untrusted(std::string why) { report_->caveats.push_back(std::move(why)); }
  /// Resolves the caveats of the stages above that gave the item of this kind which this stage replaces: they
  /// become warnings that state why. Caveats of stages whose item also goes elsewhere remain.
  void resolve_caveats(std::string_view kind, std::string why) {
    report_->lifted.insert_or_assign(std::string(kind), std::move(why));
  }
  /// Unresolved caveats of the stages above on what this stage got from them; complete when
  /// the stage is to finish.
  std::vector<std::string> caveats_above() const {
    return caveats_above_ ? caveats_above_() : std::vector<std::string>();
  }
  /// Adds the keys of this object to the stage's section of summary.json; keys given before are replaced.
  void report(const nlohmann::json& section) { report_->section.update(section); }
  /// Adds lines to what people read at the end of the run; may hold line breaks (a table).
  void print(std::string text) { report_->lines.push_back(std::move(text)); }
  /// Names a file that the results depend on, so that its hash becomes part of the provenance.
  void reads(std::filesystem::path file) { report_->read.push_back(std::move(file)); }
  /// Names a file that was written, once it is complete: a provenance record is written next to it.
  void wrote(std::filesystem::path file) { report_->written.push_back(std::move(file)); }
  /// Has the last of the stage's files written when the run is over and came to its end: `write` gets what
  /// summary.json is going to hold. Name the file by wrote() all the same, in finish(). The stage itself may
  /// be gone by then.
  void when_recorded(std::function<void(const nlohmann::ordered_json& summary)> write) {
    report_->when_recorded = std::move(write);
  }

  /// The fraction of the stage's own work that is done, 0 to 1; `what` is the current activity: "sigma 5 cm".
  void progress(double fraction, std::string_view what = {}) const {
    progress(Progress{fraction, 1, {}, what});
  }
  /// The same with an amount, so that a rate can be shown: {.done = bytes, .total = size, .unit = "B"}.
  void progress(const Progress& progress) const {
    if (progress_) progress_(progress);
  }
  /// Whether anybody wants to know the status.
  bool is_watched() const { return static_cast<bool>(status_); }
  /// Sets the stage's status; replaces the one before.
  void set_status(const StageStatus& status) const {
    if (status_) status_(status);
  }
  /// The run is to stop: return soon. The run then ends without calling finish(), so nothing is written.
  bool interrupted() const { return is_set(stop_) || is_set(abandoned_); }

  /// Sets the receiver of the status, and another flag that ends the run.
  void watch(StatusSink status, const std::atomic<bool>* abandoned) {
    status_ = std::move(status);
    abandoned_ = abandoned;
  }

  /// Sets the source of caveats_above().
  void set_caveats_above(std::function<std::vector<std::string>()> above) {
    caveats_above_ = std::move(above);
  }

 private:
  static bool is_set(const std::atomic<bool>* flag) {
    return flag != nullptr && flag->load(std::memory_order_relaxed);
  }

  const RunSettings* run_;
  StageReport* report_;
  const std::atomic<bool>* stop_;
  ProgressSink progress_;
  StatusSink status_;
  std::function<std::vector<std::string>()> caveats_above_;
  const std::atomic<bool>* abandoned_ = nullptr;
};

}  // namespace crisp
