// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <ostream>
#include <string>

#include <crisp/context.hpp>

namespace crisp::app {

/// Shows how far a run is: on a terminal as one line that is refreshed (bar, per cent, rate, time left),
/// elsewhere as plain lines, when a stage begins to report and then at most every ten seconds.
class ProgressPrinter {
 public:
  using Clock = std::function<double()>;  ///< seconds since any fixed moment

  /// @param width  columns of the terminal, at which lines are cut; 0: unknown
  ProgressPrinter(std::ostream& out, bool terminal, Clock clock, std::size_t width = 0);
  ~ProgressPrinter() { clear(); }
  ProgressPrinter(const ProgressPrinter&) = delete;
  ProgressPrinter& operator=(const ProgressPrinter&) = delete;

  void show(const std::string& tag, const Progress& progress);
  /// The status of a run without end: on a terminal the line is refreshed, elsewhere it is a plain line every
  /// ten seconds.
  void show_status(const std::string& line);
  /// Logs a line that stays, on a terminal as well.
  void log(const std::string& line);
  /// Removes the line from the terminal, so that something else can be printed.
  void clear();

 private:
  bool is_due(double now) const;
  void print(const std::string& text);
  std::string line(const Progress& progress, double now) const;

  std::ostream& out_;
  bool terminal_;
  Clock clock_;
  std::size_t width_;
  std::string tag_;
  double began_ = 0;          ///< when the stage, or its part, reported first
  double began_at_ = 0;       ///< fraction done by then
  double last_fraction_ = 0;  ///< a smaller one begins another part
  double shown_ = 0;
  bool on_screen_ = false;
  bool status_shown_ = false;
};

}  // namespace crisp::app
