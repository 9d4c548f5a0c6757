// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace crisp::stage {

/// The name of a file of which not all is known yet: in places stands any text, or any number.
class NamePattern {
 public:
  /// This very file.
  explicit NamePattern(const std::filesystem::path& file) : text_(file.string()) {}
  /// A file that comes of `path`: <stem> is its name without the ending, <ext> the ending, # any number, ####
  /// one of four digits or more, and * any text without a slash. "<stem>_####<ext>" of cloud.pcd are
  /// cloud_0001.pcd, cloud_0002.pcd and so on.
  static NamePattern given(const std::filesystem::path& path, std::string_view shape);
  /// A file in this folder, * and # as above.
  static NamePattern within(const std::filesystem::path& folder, std::string_view shape);

  NamePattern operator+(std::string_view end) const;

  /// Whether some file has a name of both patterns.
  bool overlaps(const NamePattern& other) const;
  /// The file, if all of its name is known.
  std::optional<std::filesystem::path> file() const;
  /// For people, with * for what is not known.
  std::string shown() const;

  bool operator==(const NamePattern&) const = default;

 private:
  std::string text_;  ///< a character of its own for each of the two things that are not known
};

}  // namespace crisp::stage
