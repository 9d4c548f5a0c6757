// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include <crisp/error.hpp>
#include <crisp/pcd_table.hpp>

#include "pipeline/files/control_characters.hpp"

namespace crisp {
namespace {

using Words = std::vector<std::string_view>;

constexpr std::array<std::pair<std::string_view, PcdFormat>, 3> kFormats{
    {{"ascii", PcdFormat::ascii},
     {"binary", PcdFormat::binary},
     {"binary_compressed", PcdFormat::binary_compressed}}};
constexpr std::size_t kMaxFields = 1000;
constexpr std::size_t kMaxElements = 1 << 16;
constexpr std::string_view kNote = "# crisp ";

Words words_of(std::string_view line) {
  constexpr std::string_view kBlank = " \t\r";
  Words words;
  for (std::size_t begin = line.find_first_not_of(kBlank); begin != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(kBlank, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(kBlank, end);
  }
  return words;
}

/// Parses a header line by line; keeps its position, for errors.
class HeaderReader {
 public:
  HeaderReader(std::string_view file, const std::string& name) : file_(file), name_(name) {}

  PcdHeader read() {
    while (!done_) read_line(next_line());
    finish();
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(const std::string& what, std::size_t column = 1) const {
    throw Error(what, "correct the header here, or name a PCD file",
                {.file = name_, .line = line_, .column = static_cast<int>(column)});
  }

  std::string_view next_line() {
    ++line_;
    const std::size_t end = file_.find('\n', header_.data_begin);
    if (end == std::string_view::npos) fail("the file ends before the line DATA");
    const auto line = file_.substr(header_.data_begin, end - header_.data_begin);
    header_.data_begin = end + 1;
    if (const auto at = files::find_control_character(line); at != std::string_view::npos)
      fail(files::control_character_in_words(line[at]), at + 1);
    return line;
  }

  void read_line(std::string_view line) {
    if (line.starts_with(kNote)) read_note(words_of(line.substr(kNote.size())));
    if (line.starts_with('#')) return;
    const Words words = words_of(line);
    if (words.empty()) return;
    const std::string_view key = words[0];
    if (key == "VERSION") {
      is_of_version_5_ = words.size() == 2 && (words[1] == ".5" || words[1] == "0.5");
      return;
    }
    if (key == "VIEWPOINT") return read_viewpoint(words);
    if (key == "FIELDS" || key == "COLUMNS") return read_fields(words);
    if (key == "WIDTH") return read_once(width_, words);
    if (key == "HEIGHT") return read_once(height_, words);
    if (key == "POINTS") return read_once(points_, words);
    if (key == "DATA") return read_data(words);
    if (key != "SIZE" && key != "TYPE" && key != "COUNT")
      fail(fmt::format("'{}' is no key of PCD", files::shown(key)));
    if (words.size() != header_.fields.size() + 1) {
      fail(fmt::format("{} has {} values for {} fields", key, words.size() - 1, header_.fields.size()));
    }
    for (std::size_t i = 0; i < header_.fields.size(); ++i)
      read_property(header_.fields[i], key, words[i + 1]);
  }

  void read_note(const Words& words) {
    if (words.size() == 2) header_.notes.emplace(words[0], words[1]);
  }

  void read_fields(const Words& words) {
    if (!header_.fields.empty()) fail("FIELDS is given twice");
    if (words.size() < 2 || words.size() > kMaxFields + 1) fail("FIELDS must name 1 to 1000 fields");
    for (const auto name : Words(words.begin() + 1, words.end())) {
      header_.fields.push_back({.name = std::string(name), .size = 0});  // until SIZE sets it
    }
  }

  void read_property(PcdField& field, std::string_view key, std::string_view word) {
    if (key == "TYPE") {
      if (word.size() != 1 || std::string_view("FIUfiu").find(word[0]) == std::string_view::npos)
        fail(fmt::format("there is no type '{}'", files::shown(word)));
      field.type = static_cast<char>(std::toupper(static_cast<unsigned char>(word[0])));
    } else if (key == "SIZE") {
      field.size = number(word);
    } else {
      field.count = number(word);
      if (field.count < 1 || field.count > kMaxElements) fail("COUNT must be 1 to 65536");
    }
  }

  void read_once(std::optional<std::size_t>& to, const Words& words) {
    if (to) fail(fmt::format("{} is given twice", words[0]));
    if (words.size() != 2) fail(fmt::format("{} needs one number", words[0]));
    to = number(words[1]);
  }

  void read_viewpoint(const Words& words) {
    constexpr std::array<double, 7> kOrigin = {0, 0, 0, 1, 0, 0, 0};  // a position and a quaternion
    header_.has_pose = !std::equal(words.begin() + 1, words.end(), kOrigin.begin(), kOrigin.end(),
                                   [](std::string_view word, double requested) {
                                     double value = std::numeric_limits<double>::quiet_NaN();
                                     std::from_chars(word.data(), word.data() + word.size(), value);
                                     return value == requested;
                                   });
  }

  void read_data(const Words& words) {
    const auto* format = std::find_if(kFormats.begin(), kFormats.end(), [&](const auto& f) {
      return words.size() == 2 && f.first == words[1];
    });
    if (format == kFormats.end()) fail("DATA must be ascii, binary or binary_compressed");
    header_.format = format->second;
    done_ = true;
  }

  std::size_t number(std::string_view word) const {
    std::size_t value = 0;
    const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (code != std::errc() || end != word.data() + word.size()) {
      fail(fmt::format("'{}' is no whole number", files::shown(word)));
    }
    return value;
  }

  void finish() {
    if (header_.fields.empty()) fail("FIELDS is missing");
    for (auto& field : header_.fields) {
      if (is_of_version_5_ && field.size == 0) field.size = sizeof(float);  // as all of its fields were
      const bool exists =
          field.size == 4 || field.size == 8 || (field.type != 'F' && (field.size == 1 || field.size == 2));
      if (!exists) fail(fmt::format("no number of type {} has {} bytes", field.type, field.size));
    }
    const std::size_t height = height_.value_or(1);
    header_.rows = height;
    if (!width_ && !points_) fail("neither WIDTH nor POINTS is given");
    if (width_ && height != 0 && *width_ > std::numeric_limits<std::size_t>::max() / height) {
      fail("WIDTH times HEIGHT is too large");
    }
    header_.points = points_ ? *points_ : *width_ * height;
    if (width_ && *width_ * height != header_.points) fail("POINTS is not WIDTH times HEIGHT");
  }

  std::string_view file_;
  const std::string& name_;
  PcdHeader header_;
  std::optional<std::size_t> width_;
  std::optional<std::size_t> height_;
  std::optional<std::size_t> points_;
  bool is_of_version_5_ = false;
  int line_ = 0;
  bool done_ = false;
};

}  // namespace

std::size_t PcdHeader::record_size() const {
  return std::accumulate(fields.begin(), fields.end(), std::size_t{0},
                         [](std::size_t sum, const PcdField& field) { return sum + field.width(); });
}

const PcdField* PcdHeader::find(std::string_view field) const {
  const auto found =
      std::find_if(fields.begin(), fields.end(), [&](const auto& f) { return f.name == field; });
  return found == fields.end() ? nullptr : &*found;
}

std::string to_text(const PcdHeader& header) {
  std::vector<std::string_view> names;
  std::vector<std::size_t> sizes;
  std::vector<char> types;
  std::vector<std::size_t> counts;
  for (const auto& field : header.fields) {
    names.push_back(field.name);
    sizes.push_back(field.size);
    types.push_back(field.type);
    counts.push_back(field.count);
  }
  std::string text = "# .PCD v0.7 - Point Cloud Data file format\n";
  for (const auto& [key, value] : header.notes) text += fmt::format("{}{} {}\n", kNote, key, value);
  text += fmt::format("VERSION 0.7\nFIELDS {}\nSIZE {}\nTYPE {}\nCOUNT {}\n", fmt::join(names, " "),
                      fmt::join(sizes, " "), fmt::join(types, " "), fmt::join(counts, " "));
  const auto* format = std::find_if(kFormats.begin(), kFormats.end(),
                                    [&](const auto& f) { return f.second == header.format; });
  return text + fmt::format("WIDTH {0}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {0}\nDATA {1}\n",
                            header.points, format->first);
}

PcdHeader parse_pcd_header(std::string_view file, const std::string& name) {
  return HeaderReader(file, name).read();
}

}  // namespace crisp
