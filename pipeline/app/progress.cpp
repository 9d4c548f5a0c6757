// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/app/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pipeline/app/format.hpp"

namespace crisp::app {

namespace {

double fraction_of(const Progress& progress) {
  const double ratio = progress.total > 0 ? progress.done / progress.total : 0;
  return std::isfinite(ratio) ? std::clamp(ratio, 0.0, 1.0) : 0;
}

}  // namespace

ProgressPrinter::ProgressPrinter(std::ostream& out, bool terminal, Clock clock, std::size_t width)
    : out_(out), terminal_(terminal), clock_(std::move(clock)), width_(width) {}

bool ProgressPrinter::is_due(double now) const {
  constexpr double kRefresh = 0.1;    // [s] on a terminal
  constexpr double kPlainEvery = 10;  // [s] elsewhere
  return now - shown_ >= (terminal_ ? kRefresh : kPlainEvery);
}

void ProgressPrinter::print(const std::string& text) {
  if (terminal_)  // a line that reached the last column would be two, of which one is refreshed
    out_ << "\r\x1b[K" << (width_ > 1 ? first_columns(text, width_ - 1) : text) << std::flush;
  else
    out_ << text << std::endl;
  on_screen_ = terminal_;
}

void ProgressPrinter::show_status(const std::string& line) {
  const double now = clock_();
  const bool begins = !status_shown_;
  if (!begins && !is_due(now)) return;
  shown_ = now;
  status_shown_ = true;
  print(line);
}

void ProgressPrinter::log(const std::string& line) {
  clear();
  out_ << line << std::endl;
}

void ProgressPrinter::show(const std::string& tag, const Progress& progress) {
  const double now = clock_();
  const double fraction = fraction_of(progress);
  const bool begins = tag != tag_;
  if (begins || fraction < last_fraction_) {
    began_ = now;
    began_at_ = fraction;
  }
  last_fraction_ = fraction;
  if (!begins && !is_due(now)) return;
  tag_ = tag;
  shown_ = now;
  print(line(progress, now));
}

void ProgressPrinter::clear() {
  if (on_screen_) out_ << "\r\x1b[K" << std::flush;
  on_screen_ = false;
}

std::string ProgressPrinter::line(const Progress& progress, double now) const {
  constexpr int kWidth = 24;
  constexpr double kEnoughToJudge = 0.5;  // [s] before a rate or the time left means anything
  const double elapsed = now - began_;
  const double fraction = fraction_of(progress);
  std::string text = fmt::format("{:<22}", tag_);
  if (terminal_) {
    const auto full = static_cast<std::size_t>(std::lround(fraction * kWidth));
    text += fmt::format(" [{:<{}}]", std::string(full, '#'), kWidth);
  }
  text += fmt::format(" {:3.0f} %", fraction * 100);
  if (elapsed >= kEnoughToJudge && !progress.unit.empty()) {
    text += fmt::format("  {}/s", format_amount(progress.done / elapsed, std::string(progress.unit)));
  }
  if (elapsed >= kEnoughToJudge && fraction > began_at_ && fraction < 1) {
    text += fmt::format("  {} left", format_duration(elapsed * (1 - fraction) / (fraction - began_at_)));
  }
  if (!progress.what.empty()) text += fmt::format("  {}", progress.what);
  return text;
}

}  // namespace crisp::app
