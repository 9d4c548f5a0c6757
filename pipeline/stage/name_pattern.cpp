// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/stage/name_pattern.hpp"

#include <algorithm>
#include <vector>

namespace crisp::stage {
namespace {

// No path that a person writes holds these, while * and # are letters like others in it.
constexpr char kAnyText = '\x01';
constexpr char kAnyNumber = '\x02';
constexpr char kAnyDigit = '\x03';

/// Whether it stands for one character or more.
bool is_open(char c) { return c == kAnyText || c == kAnyNumber; }

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Whether one character can stand for both.
bool can_be_same(char a, char b) {
  if (!is_open(a)) std::swap(a, b);
  if (a == kAnyText) return b != '/';
  if (a == kAnyNumber) return is_digit(b) || b == kAnyDigit || is_open(b);
  if (a == kAnyDigit) return is_digit(b) || b == kAnyDigit;
  return b == kAnyDigit ? is_digit(a) : a == b;
}

std::string with_open_places(std::string_view shape) {
  std::string text(shape);
  std::ranges::replace(text, '*', kAnyText);
  std::ranges::replace(text, '#', kAnyNumber);
  for (std::size_t i = 0; i + 1 < text.size(); ++i) {
    if (text[i] == kAnyNumber && text[i + 1] == kAnyNumber) text[i] = kAnyDigit;
  }
  return text;
}

void replace(std::string& text, std::string_view word, const std::string& by) {
  if (const auto at = text.find(word); at != std::string::npos) text.replace(at, word.size(), by);
}

}  // namespace

NamePattern NamePattern::given(const std::filesystem::path& path, std::string_view shape) {
  NamePattern name = within(path.parent_path(), shape);
  replace(name.text_, "<stem>", path.stem().string());
  replace(name.text_, "<ext>", path.extension().string());
  return name;
}

NamePattern NamePattern::within(const std::filesystem::path& folder, std::string_view shape) {
  return NamePattern(folder / with_open_places(shape));
}

NamePattern NamePattern::operator+(std::string_view end) const {
  NamePattern longer = *this;
  longer.text_ += end;
  return longer;
}

bool NamePattern::overlaps(const NamePattern& other) const {
  const std::string& a = text_;
  const std::string& b = other.text_;
  // [i][j]: whether the ends of both, from there on, can be the same; what is open takes one or more.
  std::vector<std::vector<bool>> same(a.size() + 1, std::vector<bool>(b.size() + 1, false));
  same[a.size()][b.size()] = true;
  for (std::size_t i = a.size(); i-- > 0;) {
    for (std::size_t j = b.size(); j-- > 0;) {
      if (!can_be_same(a[i], b[j])) continue;
      same[i][j] =
          same[i + 1][j + 1] || (is_open(a[i]) && same[i][j + 1]) || (is_open(b[j]) && same[i + 1][j]);
    }
  }
  return same[0][0];
}

std::optional<std::filesystem::path> NamePattern::file() const {
  const bool known = std::ranges::none_of(text_, [](char c) { return is_open(c) || c == kAnyDigit; });
  return known ? std::optional<std::filesystem::path>(text_) : std::nullopt;
}

std::string NamePattern::shown() const {
  std::string text = text_;
  std::erase(text, kAnyDigit);
  std::ranges::replace_if(text, is_open, '*');
  return text;
}

}  // namespace crisp::stage
