// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <crisp/cloud.hpp>

#include "plugins/write/record_buffer.hpp"

namespace crisp::write {

/// Writes a binary little-endian PLY file point by point: x, y, z, intensity, laser, beam and time, all
/// exactly as the cloud has them.
class PlyWriter {
 public:
  static constexpr const char* kStage = "write.ply";
  static constexpr const char* kSummary = "writes the cloud as a PLY file";
  static constexpr const char* kEnding = ".ply";
  static constexpr const char* kDetails =
      "Binary, little-endian, with the properties x, y, z, intensity (float), laser, beam (ushort) and time: seconds, as double, since the epoch that the comment `crisp epoch_ns` in the header gives in nanoseconds since 1970. Every number is exactly the cloud's. PCL reads it, as do most viewers.";

  /// @param stamp  [µs since the Unix epoch] which the points' times count from
  PlyWriter(const std::filesystem::path& file, std::uint64_t stamp, const Point& first);

  void add(const Point& point, std::size_t recording);
  /// Corrects the count in the header, and puts the file in its place.
  void commit();
  std::uint64_t points() const { return points_; }  ///< that the file holds
  static std::map<std::string, std::uint64_t> losses() { return {}; }
  static std::vector<std::string> warnings() { return {}; }

 private:
  std::string header() const;

  AtomicFile file_;
  std::uint64_t stamp_;
  std::uint64_t points_ = 0;
  RecordBuffer records_;
};

}  // namespace crisp::write
