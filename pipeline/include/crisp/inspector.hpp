// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include <crisp/rig.hpp>

namespace crisp {

/// Description of a file: for people, and for programs.
// NOLINTNEXTLINE(bugprone-exception-escape): moving JSON checks what it holds
struct Inspection {
  std::string text;     ///< lines, without a line break at the end
  nlohmann::json data;  ///< the same as an object
};

/// Describes the content of files of some kind: `crisp info`.
struct Inspector {
  std::string kind;  ///< "a capture"
  /// Whether the file is of that kind, by its first bytes (up to 4096 of them).
  std::function<bool(std::string_view head)> recognises;
  /// @throws Error if the file cannot be read
  std::function<Inspection(const std::filesystem::path& file, const Rig& rig)> inspect;
  /// The extensions of such files, ".pcap": one that is named so (see has_extension()) and is none is an
  /// error.
  std::vector<std::string> extensions = {};
  /// Compares two files of this kind, as lines for people; empty where files are described one by one.
  /// @throws Error if one cannot be read
  std::function<std::string(const std::filesystem::path& first, const std::filesystem::path& second)>
      compare = {};
  /// The content of a file of this kind as URDF for ROS; empty where it has none.
  /// @throws Error if it cannot be read
  std::function<std::string(const std::filesystem::path& file, const Rig& rig)> urdf = {};
};

using Inspectors = std::vector<Inspector>;

}  // namespace crisp
