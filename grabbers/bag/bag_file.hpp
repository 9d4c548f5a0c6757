// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <istream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "grabbers/bag/bag_reader.hpp"
#include "pipeline/files/byte_stream.hpp"

namespace crisp::bag {

/// How bags' names end.
inline std::vector<std::string> bag_extensions() { return {".bag", ".mcap", ".db3"}; }

/// Whether a file is a bag, or an SQLite database, which may be one, by its first bytes.
bool is_bag(std::string_view head);

/// The files of a bag: the file itself, or those of a folder as ROS 2 writes them, in the order of their
/// names.
/// @throws Error if a folder holds no bag
std::vector<std::filesystem::path> files_of_bag(const std::filesystem::path& path);

/// A bag's file of any format: rosbag 2.0 (ROS 1), MCAP, or SQLite (ROS 2's .db3).
class BagFile {
 public:
  /// @param interrupted  polled: whether to give up; may be empty
  /// @throws Error if the file cannot be read or is no bag
  explicit BagFile(const std::filesystem::path& file, std::function<bool()> interrupted = {});

  BagReader& reader() { return *reader_; }

 private:
  std::optional<files::ByteStream> bytes_;
  std::optional<files::ByteStreamBuffer> buffer_;
  std::optional<std::istream> stream_;
  std::unique_ptr<BagReader> reader_;
};

}  // namespace crisp::bag
