// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/files/yaml.hpp"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <optional>
#include <set>
#include <sstream>

#include <crisp/error.hpp>

#include "pipeline/files/byte_stream.hpp"
#include "pipeline/files/control_characters.hpp"

namespace crisp::files {
namespace {

// Within {} and [], YAML ends a plain scalar at a brace, so `{file: ${input}}` would not parse. The braces of
// a variable are hidden from the parser behind two control characters, one byte each, so that columns stay
// right.
constexpr char kOpen = '\x01';
constexpr char kClose = '\x02';

bool is_name_character(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

std::string parser_text(std::string_view text) {
  // Without its last line breaks: yaml-cpp does not notice a quote that is still open at one.
  std::string hidden(text.substr(0, text.find_last_not_of(" \t\r\n") + 1));
  for (std::size_t at = hidden.find("${"); at != std::string::npos; at = hidden.find("${", at + 2)) {
    std::size_t end = at + 2;
    while (end < hidden.size() && is_name_character(hidden[end])) ++end;
    if (end == at + 2 || end == hidden.size() || hidden[end] != '}') continue;
    hidden[at + 1] = kOpen;
    hidden[end] = kClose;
  }
  return hidden;
}

std::string show_variables(std::string text) {
  std::replace(text.begin(), text.end(), kOpen, '{');
  std::replace(text.begin(), text.end(), kClose, '}');
  return text;
}

/// Refuses what no person writes into a text file, and what would be taken for a hidden brace.
void check_characters(std::string_view text, const std::string& file) {
  const std::size_t at = find_control_character(text);
  if (at == std::string_view::npos) return;
  const std::string_view before = text.substr(0, at);
  const auto line = static_cast<int>(std::ranges::count(before, '\n')) + 1;
  const auto column = static_cast<int>(at - (before.rfind('\n') + 1)) + 1;  // npos + 1 is 0
  throw Error(control_character_in_words(text[at]), "is this a text file?", {file, line, column});
}

/// Advice for a syntax error, which the parser mostly finds lines after the mistake.
std::string advice_on_syntax(int line) {
  return std::string(line > 1 ? "the mistake may be on a line before it: " : "") +
         "check for a bracket or a quotation mark that is not closed, or a missing colon";
}

/// The first line up to `last` that has a tab before its text.
std::optional<int> indented_by_tab(std::string_view text, int last) {
  int number = 1;
  for (std::size_t begin = 0; begin < text.size() && number <= last; ++number) {
    const std::string_view line = text.substr(begin, text.find('\n', begin) - begin);
    const std::string_view blank = line.substr(0, line.find_first_not_of(" \t"));
    if (blank.size() < line.size() && blank.find('\t') != std::string_view::npos) return number;
    begin += line.size() + 1;
  }
  return std::nullopt;
}

/// Builds the tree from the parser's events; keeps all errors that leave the rest readable.
class TreeBuilder final : public YAML::EventHandler {
 public:
  explicit TreeBuilder(std::string file) : file_(std::move(file)) {
    root.place = {file_, 1, 1};  // of a file that is empty
  }

  YamlNode root;
  std::vector<Error> errors;

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    check_anchor(mark, anchor);
    add(node(mark, YamlNode::Kind::null));
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    fail("aliases (*name) are not supported", "write the value out, or use vars:", place(mark));
    add(node(mark, YamlNode::Kind::null));
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    check_anchor(mark, anchor);
    check_tag(mark, tag);
    YamlNode scalar = node(mark, YamlNode::Kind::scalar);
    scalar.text = show_variables(value);
    scalar.quoted = tag == "!";
    add(std::move(scalar));
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(mark, tag, anchor, YamlNode::Kind::sequence);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(mark, tag, anchor, YamlNode::Kind::map);
  }
  void OnMapEnd() override { close(); }

 private:
  /// A sequence or map that is being read.
  struct Level {
    YamlNode node;
    bool awaits_value = false;  ///< a map whose last key has no value yet
    std::set<std::string> keys;
  };

  void fail(const std::string& what, const std::string& advice, const Place& at) {
    constexpr std::size_t kEnough = 100;  // nobody reads more, and a file of nothing else shall not take long
    errors.emplace_back(what, advice, at);
    if (errors.size() >= kEnough) throw Errors(std::move(errors));
  }

  Place place(const YAML::Mark& mark) const { return {file_, mark.line + 1, mark.column + 1}; }

  YamlNode node(const YAML::Mark& mark, YamlNode::Kind kind) const {
    YamlNode made;
    made.kind = kind;
    made.place = place(mark);
    return made;
  }

  void check_anchor(const YAML::Mark& mark, YAML::anchor_t anchor) {
    if (anchor == YAML::NullAnchor) return;
    fail("anchors (&name) are not supported", "use vars:", place(mark));
  }
  void check_tag(const YAML::Mark& mark, const std::string& tag) {
    if (tag.empty() || tag == "?" || tag == "!") return;
    fail("tags (" + tag + ") are not understood", "leave it out", place(mark));
  }

  void open(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, YamlNode::Kind kind) {
    constexpr std::size_t kDeepest = 64;
    if (levels_.size() >= kDeepest)
      throw Error(fmt::format("lists and maps are nested more than {} deep", kDeepest), "remove some levels",
                  place(mark));
    check_anchor(mark, anchor);
    check_tag(mark, tag);
    levels_.push_back({node(mark, kind), false, {}});
  }
  void close() {
    YamlNode done = std::move(levels_.back().node);
    levels_.pop_back();
    add(std::move(done));
  }

  void add(YamlNode child) {
    if (levels_.empty()) {
      root = std::move(child);
      return;
    }
    Level& level = levels_.back();
    if (level.node.kind == YamlNode::Kind::sequence) {
      level.node.items.push_back(std::move(child));
    } else if (level.awaits_value) {
      level.node.entries.back().value = std::move(child);
      level.awaits_value = false;
    } else {
      add_key(level, std::move(child));
    }
  }

  void add_key(Level& level, YamlNode key) {
    if (key.kind != YamlNode::Kind::scalar) {
      fail("a key must be a name, not " + describe(key), "write NAME: VALUE, without [ or { before the colon",
           key.place);
    } else if (!level.keys.insert(key.text).second) {
      const auto same = std::find_if(level.node.entries.begin(), level.node.entries.end(),
                                     [&](const YamlEntry& entry) { return entry.key == key.text; });
      fail("'" + key.text + "' is given twice", fmt::format("the first is in line {}", same->place.line),
           key.place);
    }
    level.node.entries.push_back({std::move(key.text), std::move(key.place), {}});
    level.awaits_value = true;
  }

  std::string file_;
  std::vector<Level> levels_;
};

/// Second and further documents are only parsed to detect them.
struct IgnoreAll final : YAML::EventHandler {
  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t, const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {
  }
  void OnMapEnd() override {}
};

}  // namespace

const YamlNode* YamlNode::find(std::string_view key) const {
  const auto found =
      std::find_if(entries.begin(), entries.end(), [&](const YamlEntry& entry) { return entry.key == key; });
  return found == entries.end() ? nullptr : &found->value;
}

std::filesystem::path path_of(const YamlNode& node, const std::filesystem::path& folder) {
  return ((node.from_command_line ? std::filesystem::current_path() : folder) / node.text).lexically_normal();
}

std::string describe(const YamlNode& node) {
  constexpr std::size_t kLongest = 60;
  switch (node.kind) {
    case YamlNode::Kind::null:
      return "nothing";
    case YamlNode::Kind::sequence:
      return "a list";
    case YamlNode::Kind::map:
      return "a map";
    case YamlNode::Kind::scalar:
      break;
  }
  return "'" + (node.text.size() > kLongest ? node.text.substr(0, kLongest) + "…" : node.text) + "'";
}

YamlNode parse_yaml(std::string_view text, const std::string& file) {
  check_characters(text, file);
  std::istringstream stream(parser_text(text));
  TreeBuilder builder(file);
  try {
    YAML::Parser parser(stream);
    parser.HandleNextDocument(builder);
    IgnoreAll ignore;
    if (parser.HandleNextDocument(ignore))
      throw Error("there is more than one document in it", "remove the line --- and what follows it", {file});
  } catch (const YAML::Exception& error) {
    const Place place = {file, error.mark.line + 1, error.mark.column + 1};
    const auto tab = indented_by_tab(text, place.line);
    builder.errors.push_back(
        tab ? Error("a tab indents this line, which YAML does not allow", "indent by blanks", {file, *tab, 1})
            : Error("this is not YAML: " + error.msg, advice_on_syntax(place.line), place));
  }
  if (!builder.errors.empty()) throw Errors(std::move(builder.errors));
  return std::move(builder.root);
}

YamlNode read_yaml(const std::filesystem::path& file) {
  constexpr std::size_t kLimit = 4 << 20;
  YamlNode root = parse_yaml(read_text_file(file, kLimit), file.string());
  if (root.kind == YamlNode::Kind::null)
    throw Error("the file is empty", "write it, or name another file", {file.string()});
  return root;
}

std::string read_text_file(const std::filesystem::path& file, std::size_t limit) {
  const auto fail = [&](const std::string& why, const std::string& advice) {
    return Error("cannot read " + file.string() + ": " + why, advice);
  };
  std::error_code missing;  // reported by reading
  if (std::filesystem::is_directory(file, missing)) throw fail("it is a folder", "name a file in it");
  constexpr auto kPatience = std::chrono::seconds(10);
  auto give_up = std::chrono::steady_clock::now() + kPatience;
  ByteStream stream(file, [&] { return std::chrono::steady_clock::now() > give_up; });
  std::string text(limit + 1, '\0');
  std::size_t end = 0;
  try {
    while (end < text.size()) {
      const std::size_t got = stream.read(text.data() + end, text.size() - end);
      if (got == 0) break;
      end += got;
      give_up = std::chrono::steady_clock::now() + kPatience;
    }
  } catch (const Interrupted&) {
    throw fail("it is a pipe without data for 10 s", "check the program that writes into it");
  }
  text.resize(end);
  if (text.size() > limit)
    throw fail(fmt::format("it is longer than {} bytes", limit), "is this the right file?");
  return text;
}

}  // namespace crisp::files
