// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <crisp/error.hpp>

namespace crisp::files {

struct YamlEntry;

/// A YAML document as crisp understands it: null, scalars, sequences and maps, each with its place. Anchors,
/// aliases, tags and keys that are not plain texts are rejected; so nothing refers to anything else, and a
/// document is never larger than its file. Scalars are texts: the reader interprets them.
struct YamlNode {
  enum class Kind { null, scalar, sequence, map };

  Kind kind = Kind::null;
  std::string text;                ///< of a scalar
  bool quoted = false;             ///< whether the scalar was written in quotes
  bool from_command_line = false;  ///< then a path is relative to the current folder, not to the file's
  Place place;
  std::vector<YamlNode> items;     ///< of a sequence
  std::vector<YamlEntry> entries;  ///< of a map, in the order of the file; no key is there twice

  const YamlNode* find(std::string_view key) const;  ///< the value of a key of a map, or nullptr
};

struct YamlEntry {
  std::string key;
  Place place;  ///< of the key
  YamlNode value;
};

/// Description of a node, for messages: "a list", "a map", "nothing", "'5 cm'".
std::string describe(const YamlNode& node);

/// The path that a scalar names, made absolute.
/// @param folder  of the file, which paths in it are relative to
std::filesystem::path path_of(const YamlNode& node, const std::filesystem::path& folder);

/// Parses one document. `${name}` may stand wherever a plain scalar may, also within `{}` and `[]`.
/// @param file  the name to give in messages
/// @throws Error or Errors  with file:line:column: what is not YAML, not understood (see YamlNode), keys that
///         are given twice, nesting deeper than 64
YamlNode parse_yaml(std::string_view text, const std::string& file);

/// Reads a file of at most 4 MiB and parses it.
YamlNode read_yaml(const std::filesystem::path& file);

/// @throws Error if the file cannot be read or is longer than `limit` bytes, or if it is a pipe into which
/// nothing is
///         written for 10 s
std::string read_text_file(const std::filesystem::path& file, std::size_t limit);

}  // namespace crisp::files
