// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/batch/manifest_line.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <limits>
#include <string>

namespace crisp::batch {
namespace {

constexpr std::array kKinds = {"batch", "start", "end", "same", "retry"};

/// [ms since the Unix epoch] of "2026-01-31T12:00:00.123Z"; 0 if it is no such time.
std::int64_t milliseconds_of(std::string_view text) {
  constexpr std::string_view kForm = "dddd-dd-ddTdd:dd:dd.dddZ";
  const auto fits = [](char c, char form) { return form == 'd' ? c >= '0' && c <= '9' : c == form; };
  if (text.size() != kForm.size() || !std::ranges::equal(text, kForm, fits)) return 0;
  const auto number = [text](std::size_t at, std::size_t digits) {
    int value = 0;
    for (const char c : text.substr(at, digits)) value = 10 * value + (c - '0');
    return value;
  };
  namespace chrono = std::chrono;
  const chrono::year_month_day date(chrono::year(number(0, 4)),
                                    chrono::month(static_cast<unsigned>(number(5, 2))),
                                    chrono::day(static_cast<unsigned>(number(8, 2))));
  if (!date.ok()) return 0;
  const auto time = chrono::sys_days(date) + chrono::hours(number(11, 2)) + chrono::minutes(number(14, 2)) +
                    chrono::seconds(number(17, 2)) + chrono::milliseconds(number(20, 3));
  return chrono::duration_cast<chrono::milliseconds>(time.time_since_epoch()).count();
}

/// SAX handler of nlohmann's parser: fills an event, and stops at keys that only a table needs.
class EventReader : public nlohmann::json_sax<nlohmann::json> {
 public:
  BatchEvent event;
  bool is_event = false;
  bool stopped = false;  ///< where only a table reads on

  bool key(string_t& key) override {
    stopped = depth_ == 1 && (key == "exit" || key == "results");
    if (depth_ == 1) top_ = key;
    key_ = std::move(key);
    return !stopped;
  }
  bool string(string_t& text) override {
    if (in_input()) {
      if (key_ == "file") {
        file().file = std::move(text);
      } else if (key_ == "sha256") {
        file().sha256 = std::move(text);
      }
    } else if (depth_ == 1) {
      set(std::move(text));
    }
    return true;
  }
  bool number_integer(number_integer_t number) override { return set_number(number); }
  bool number_unsigned(number_unsigned_t number) override {
    constexpr number_unsigned_t kMax = std::numeric_limits<std::int64_t>::max();
    return set_number(static_cast<std::int64_t>(std::min(number, kMax)));
  }
  bool start_object(std::size_t) override {
    ++depth_;
    if (in_input()) event.input.emplace_back();
    return true;
  }
  bool end_object() override { return --depth_, true; }
  bool start_array(std::size_t) override { return ++depth_, true; }
  bool end_array() override { return --depth_, true; }
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool parse_error(std::size_t, const std::string&, const nlohmann::json::exception&) override {
    return false;
  }

 private:
  static constexpr int kInFile = 3;  // the event, its list `input`, an object in that

  bool in_input() const { return depth_ == kInFile && top_ == "input"; }
  InputFile& file() { return event.input.back(); }

  bool set_number(std::int64_t number) {
    if (in_input() && key_ == "bytes") file().bytes = static_cast<std::uint64_t>(number);
    if (in_input() && key_ == "mtime") file().mtime = number;
    return true;
  }

  void set(std::string&& text) {
    if (key_ == "event") {
      const auto kind = std::ranges::find(kKinds, text);
      is_event = kind != kKinds.end();
      if (is_event) event.kind = static_cast<BatchEventKind>(kind - kKinds.begin());
    } else if (key_ == "time") {
      event.time = milliseconds_of(text);
      is_event = is_event && event.time > 0;
    } else if (key_ == "name") {
      event.name = std::move(text);
    } else if (key_ == "settings") {
      event.settings = std::move(text);
    } else if (key_ == "status") {
      event.status = JobStatus::interrupted;
      for (const auto status : {JobStatus::done, JobStatus::untrusted, JobStatus::failed}) {
        if (text == name_of(status)) event.status = status;
      }
    }
  }

  int depth_ = 0;
  std::string top_;  ///< the last key of the event itself
  std::string key_;  ///< the last key of all
};

}  // namespace

std::string_view name_of(BatchEventKind kind) { return kKinds.at(static_cast<std::size_t>(kind)); }

std::optional<BatchEvent> parse_manifest_line(std::string_view line) {
  EventReader reader;
  const bool whole = nlohmann::json::sax_parse(line.begin(), line.end(), &reader);
  if ((!whole && !reader.stopped) || !reader.is_event) return std::nullopt;
  return std::move(reader.event);
}

}  // namespace crisp::batch
