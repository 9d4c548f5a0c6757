// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/bag/bag_file.hpp"

#include <algorithm>
#include <fstream>

#include <crisp/error.hpp>

#include "grabbers/bag/mcap_reader.hpp"
#include "grabbers/bag/rosbag1_reader.hpp"
#include "grabbers/bag/sqlite_reader.hpp"
#include "pipeline/files/list_files.hpp"

namespace crisp::bag {
namespace {

/// The first bytes of a file, enough to determine its format.
struct Begin {
  std::string bytes;
  bool is_compressed = false;
};

Begin begin_of(const std::filesystem::path& file) {
  constexpr std::size_t kEnoughBytes = 16;
  files::ByteStream stream(file);
  std::string bytes(kEnoughBytes, '\0');
  bytes.resize(stream.read(bytes.data(), bytes.size()));
  return {.bytes = bytes, .is_compressed = !bytes.empty() && stream.size() == 0};
}

}  // namespace

bool is_bag(std::string_view head) {
  return head.starts_with(Rosbag1Reader::kMagic) || head.starts_with(McapReader::kMagic) ||
         head.starts_with(SqliteReader::kMagic);
}

std::vector<std::filesystem::path> files_of_bag(const std::filesystem::path& path) {
  if (!std::filesystem::is_directory(path)) return {path};
  std::vector<std::filesystem::path> files;
  for (const auto& file : files::list_files(path)) {
    if (files::has_extension(file, {".mcap", ".db3", ".bag"})) files.push_back(file);
  }
  if (files.empty())
    throw Error(path.string() + " holds no bag", "a bag is a file NAME.bag, NAME.mcap or NAME.db3");
  return files;
}

BagFile::BagFile(const std::filesystem::path& file, std::function<bool()> interrupted) {
  const auto [begin, is_compressed] = begin_of(file);
  if (begin.starts_with(SqliteReader::kMagic)) {
    if (is_compressed)
      throw Error(file.string() + " is a compressed database, which must be decompressed first", "unzstd it");
    reader_ = std::make_unique<SqliteReader>(file);
    return;
  }
  if (!is_bag(begin)) {
    throw Error(file.string() + " is no bag of a known format",
                "known formats are ROS 1's (.bag, version 2.0), MCAP and ROS 2's in SQLite (.db3)");
  }
  bytes_.emplace(file, std::move(interrupted));
  buffer_.emplace(*bytes_);
  stream_.emplace(&*buffer_);
  stream_->exceptions(std::ios::badbit);
  if (begin.starts_with(McapReader::kMagic))
    reader_ = std::make_unique<McapReader>(*stream_);
  else
    reader_ = std::make_unique<Rosbag1Reader>(*stream_);
}

}  // namespace crisp::bag
