// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/telegrams/sick_scan_xd_json.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <streambuf>
#include <string_view>
#include <utility>
#include <vector>

#include <crisp/error.hpp>

namespace crisp::telegrams {
namespace {

constexpr std::size_t kLongestElement = 64 << 20;  // [bytes] thousands of times a telegram's

/// Hands a text on to the parser; knows where that is, and ends what never comes to its next element.
class WatchedText final : public std::streambuf {
 public:
  WatchedText(std::istream& text, const std::string& name) : text_(text), name_(name), buffer_(1 << 16) {}

  /// Place of the n-th byte, from 0, of the last bytes handed on.
  Place place_of(std::size_t byte) const {
    const auto read = static_cast<std::size_t>(gptr() - eback());
    const std::size_t in_buffer = std::min(byte - std::min(byte, begin_), read);
    const std::string_view before(buffer_.data(), in_buffer);
    const auto lines = std::ranges::count(before, '\n');
    const std::size_t column = lines > 0 ? before.size() - before.rfind('\n') - 1 : column_ + before.size();
    return {name_, line_ + static_cast<int>(lines), static_cast<int>(column) + 1};
  }

  void element_ends() { since_element_ = 0; }

 protected:
  int_type underflow() override {
    const std::string_view passed(buffer_.data(), static_cast<std::size_t>(egptr() - eback()));
    since_element_ += passed.size();
    if (since_element_ > kLongestElement)
      throw Error("an element of more than 64 MiB begins before this", "check that it is a list of telegrams",
                  place_of(begin_ + passed.size()));
    text_.read(next_.data(), static_cast<std::streamsize>(next_.size()));
    const auto got = static_cast<std::size_t>(text_.gcount());
    if (got == 0) return traits_type::eof();
    begin_ += passed.size();
    const auto lines = std::ranges::count(passed, '\n');
    column_ = lines > 0 ? passed.size() - passed.rfind('\n') - 1 : column_ + passed.size();
    line_ += static_cast<int>(lines);
    std::swap(buffer_, next_);
    setg(buffer_.data(), buffer_.data(), buffer_.data() + got);
    return traits_type::to_int_type(*gptr());
  }

 private:
  std::istream& text_;
  const std::string& name_;
  std::vector<char> buffer_;
  std::vector<char> next_ = std::vector<char>(1 << 16);
  std::size_t since_element_ = 0;
  std::size_t begin_ = 0;   ///< [bytes] of the text before the buffer
  int line_ = 1;            ///< in which the buffer begins
  std::size_t column_ = 0;  ///< likewise, from 0
};

/// The element at the end of a path of keys, or nullptr.
const nlohmann::json* at(const nlohmann::json& from, std::initializer_list<const char*> path) {
  const nlohmann::json* here = &from;
  for (const char* key : path) {
    if (!here->is_object()) return nullptr;
    const auto next = here->find(key);
    if (next == here->end()) return nullptr;
    here = &*next;
  }
  return here;
}

/// "02:1f:…"; nothing if it is not of this form.
std::optional<wire::Bytes> bytes_of(std::string_view text) {
  constexpr std::size_t kDigits = 2;
  wire::Bytes bytes;
  bytes.reserve(text.size() / (kDigits + 1) + 1);
  while (!text.empty()) {
    std::uint8_t byte = 0;
    const char* end = text.data() + std::min(kDigits, text.size());
    constexpr int kHexadecimal = 16;
    const auto read = std::from_chars(text.data(), end, byte, kHexadecimal);
    if (read.ptr != text.data() + kDigits) return std::nullopt;
    bytes.push_back(byte);
    text.remove_prefix(kDigits);
    if (text.empty()) break;
    if (text.front() != ':') return std::nullopt;
    text.remove_prefix(1);
  }
  return bytes;
}

/// A number, or a text that is one [s].
std::optional<std::int64_t> nanoseconds(const nlohmann::json& time) {
  double seconds = -1;
  if (time.is_number()) {
    seconds = time.get<double>();
  } else if (const auto* text = time.get_ptr<const std::string*>()) {
    const auto read = std::from_chars(text->data(), text->data() + text->size(), seconds);
    if (read.ec != std::errc() || read.ptr != text->data() + text->size()) return std::nullopt;
  }
  constexpr double kLongest = 1e9;  // [s] 30 years
  if (!(seconds >= 0 && seconds <= kLongest)) return std::nullopt;
  return std::llround(1e9 * seconds);
}

/// Telegram of an element of the list; nothing, and counted, if it is none.
std::optional<ListedTelegram> telegram_of(const nlohmann::json& entry, Counts& losses) {
  const auto* payload = at(entry, {"_source", "layers", "tcp", "tcp.payload"});
  const auto* time = at(entry, {"_source", "layers", "tcp", "Timestamps", "tcp.time_relative"});
  if (payload == nullptr || !payload->is_string()) {
    losses.add("entries without a payload");
    return std::nullopt;
  }
  auto bytes = bytes_of(payload->get_ref<const std::string&>());
  const auto time_ns = time != nullptr ? nanoseconds(*time) : std::nullopt;
  if (!bytes) losses.add("entries whose payload is not hexadecimal");
  if (bytes && !time_ns) losses.add("entries without a time");
  if (!bytes || !time_ns) return std::nullopt;
  return ListedTelegram{*time_ns, std::move(*bytes)};
}

}  // namespace

void read_telegram_list(std::istream& text, const std::string& name, Counts& losses,
                        const std::function<void(ListedTelegram)>& use) {
  using Event = nlohmann::json::parse_event_t;
  WatchedText watched(text, name);
  std::istream watched_text(&watched);
  const auto refuse_no_list = [&] {
    throw Error("this is no list of telegrams", "give a JSON array", Place{name, 1, 1});
  };
  // Elements are used as soon as they are complete, and not kept.
  const auto take = [&](int depth, Event event, nlohmann::json& value) {
    if (depth == 0 && (event == Event::object_start || event == Event::value)) refuse_no_list();
    const bool is_element =
        depth == 1 && (event == Event::object_end || event == Event::array_end || event == Event::value);
    if (!is_element) return true;
    watched.element_ends();
    if (auto telegram = telegram_of(value, losses)) use(std::move(*telegram));
    return false;
  };
  try {
    const bool is_list = nlohmann::json::parse(watched_text, take).is_array();
    if (!is_list) refuse_no_list();
  } catch (const nlohmann::json::exception& error) {
    const auto* where = dynamic_cast<const nlohmann::json::parse_error*>(&error);
    const std::size_t byte = where != nullptr && where->byte > 0 ? where->byte - 1 : 0;
    throw Error("this is no JSON", "check that it is a complete list of telegrams", watched.place_of(byte));
  }
}

}  // namespace crisp::telegrams
