// SPDX-License-Identifier: BSD-3-Clause
#include "tests/sources/type_names.hpp"

#include <algorithm>
#include <cctype>
#include <optional>

namespace crisp::test {
namespace {

struct Token {
  std::string_view text;
  int line = 0;
};

bool in_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

/// Words and signs, without comments, literals and the preprocessor's lines.
class Tokens {
 public:
  explicit Tokens(std::string_view source) : source_(source) {
    while (at_ < source_.size()) step();
  }
  const std::vector<Token>& all() const { return all_; }

 private:
  bool begins(std::string_view what) const { return source_.substr(at_).starts_with(what); }

  void skip_to(std::size_t end) {
    end = std::min(end, source_.size());
    line_ += static_cast<int>(std::count(source_.begin() + static_cast<std::ptrdiff_t>(at_),
                                         source_.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
    at_ = end;
  }
  void skip_past(std::string_view end) {
    const auto found = source_.find(end, at_);
    skip_to(found == std::string_view::npos ? found : found + end.size());
  }
  void skip_literal(char quote) {
    std::size_t end = at_ + 1;
    while (end < source_.size() && source_[end] != quote) end += source_[end] == '\\' ? 2 : 1;
    skip_to(end + 1);
  }
  void skip_raw_literal() {
    const auto open = source_.find('(', at_);
    skip_past(")" + std::string(source_.substr(at_ + 2, open - at_ - 2)) + "\"");
  }
  void skip_directive() {
    auto end = source_.find('\n', at_);
    while (end != std::string_view::npos && source_[end - 1] == '\\') end = source_.find('\n', end + 1);
    skip_to(end);
  }

  void step() {
    const char c = source_[at_];
    if (begins("//")) return skip_to(source_.find('\n', at_));
    if (begins("/*")) return skip_past("*/");
    if (begins("R\"")) return skip_raw_literal();
    if (c == '#') return skip_directive();
    if (c == '"' || c == '\'') return skip_literal(c);
    if (std::isspace(static_cast<unsigned char>(c))) return skip_to(at_ + 1);
    std::size_t end = at_ + 1;
    // an apostrophe in a number begins no literal
    const bool number = std::isdigit(static_cast<unsigned char>(c)) != 0;
    while (in_word(c) && end < source_.size() &&
           (in_word(source_[end]) || (number && source_[end] == '\''))) {
      ++end;
    }
    if (begins("::")) end = at_ + 2;
    all_.push_back({source_.substr(at_, end - at_), line_});
    skip_to(end);
  }

  std::string_view source_;
  std::size_t at_ = 0;
  int line_ = 1;
  std::vector<Token> all_;
};

class Reader {
 public:
  explicit Reader(const std::vector<Token>& tokens) : tokens_(tokens) {
    while (at_ < tokens_.size()) step();
  }
  std::vector<NamedType> take() { return std::move(types_); }

 private:
  std::string_view text(std::size_t at) const { return at < tokens_.size() ? tokens_[at].text : ""; }
  bool visible() const {
    return std::ranges::all_of(scopes_, [](const auto& scope) { return scope.has_value(); });
  }

  void step() {
    if (text(at_) == "}" && !scopes_.empty()) scopes_.pop_back();
    if (text(at_) == "{") scopes_.emplace_back();
    if (text(at_) == "namespace" && enter_namespace()) return;
    const bool of_enumeration = text(at_ - 1) == "enum";
    const bool type = text(at_) == "struct" || text(at_) == "union" || text(at_) == "enum" ||
                      (text(at_) == "class" && !of_enumeration);
    if (type && visible()) note_type();
    ++at_;
  }

  /// False for an alias and a using-directive.
  bool enter_namespace() {
    std::size_t end = at_ + 1;
    std::string name;
    for (; text(end) == "::" || (!text(end).empty() && in_word(text(end)[0])); ++end) name += text(end);
    if (text(end) != "{") return false;
    scopes_.push_back(name.empty() ? std::nullopt : std::optional(name + "::"));
    at_ = end + 1;
    return true;
  }

  /// A type's name is the last word before what opens it or names what it derives from.
  void note_type() {
    std::size_t end = at_ + 1;
    if (text(end) == "class" || text(end) == "struct") ++end;  // of an enumeration
    std::size_t name = 0;
    for (; end < tokens_.size(); ++end) {
      if (text(end) == "alignas") {
        while (text(end) != ")") ++end;
      } else if (in_word(text(end)[0])) {
        if (text(end) != "final") name = end;
      } else if (text(end) != "[" && text(end) != "]") {
        break;
      }
    }
    if (name == 0 || (text(end) != "{" && text(end) != ":")) return;
    std::string full;
    for (const auto& scope : scopes_) full += *scope;
    types_.push_back({full + std::string(text(name)), tokens_[name].line});
  }

  const std::vector<Token>& tokens_;
  std::size_t at_ = 0;
  std::vector<std::optional<std::string>> scopes_;  // named namespaces; nothing for all else
  std::vector<NamedType> types_;
};

}  // namespace

std::vector<NamedType> named_types(std::string_view source) {
  const Tokens tokens(source);
  return Reader(tokens.all()).take();
}

}  // namespace crisp::test
