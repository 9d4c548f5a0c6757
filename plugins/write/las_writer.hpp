// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <crisp/cloud.hpp>

#include "plugins/write/las_grid.hpp"
#include "plugins/write/record_buffer.hpp"

namespace crisp::write {

/// Writes a LAS file point by point: version 1.4, point format 6, with laser and beam as extra bytes.
/// After the LAS specification 1.4 R15 of the ASPRS.
class LasWriter {
 public:
  static constexpr const char* kStage = "write.las";
  static constexpr const char* kSummary = "writes the cloud as a LAS file";
  static constexpr const char* kEnding = ".las";
  static constexpr const char* kDetails =
      "LAS 1.4, point format 6, with the extra bytes laser and beam. Coordinates are whole tenths of a millimetre, so that rounding changes none by more than 0.05 mm. Where points are more than 214 km from the file's offset, it moves to their middle; where the cloud does not fit then, the steps become 1 mm, or as much coarser as necessary, and a warning states them. Points beyond 1.6 million km are left out and counted. Intensities are whole numbers from 0 to 65535, and those that are not are rounded and counted. Times are adjusted standard GPS time, with the leap seconds of the recording's day, exact to 0.1 µs; where the cloud has no date they are seconds since its epoch. The point source ID counts recordings from 1.";

  /// @param stamp  [µs since the Unix epoch] which the points' times count from
  /// @param first  of the points, near which the offset is at first
  LasWriter(const std::filesystem::path& file, std::uint64_t stamp, const Point& first);

  void add(const Point& point, std::size_t recording);
  /// Corrects counts and extents in the header, and puts the file in its place.
  void commit();
  std::uint64_t points() const { return points_; }  ///< that the file holds
  std::map<std::string, std::uint64_t> losses() const;
  /// What the file holds less finely than it should.
  std::vector<std::string> warnings() const;

 private:
  std::string header() const;
  bool widen(const std::array<double, 3>& position);
  void move_records(const LasGrid& to);

  AtomicFile file_;
  std::uint64_t stamp_;
  double time_shift_ = 0;  ///< [s] of a point's time to what the file has
  LasGrid grid_;
  Extent extent_;  ///< of the points so far
  std::uint64_t points_ = 0;
  std::uint64_t too_far_ = 0;
  std::uint64_t rounded_intensities_ = 0;
  RecordBuffer records_;
};

}  // namespace crisp::write
