// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <crisp/rig.hpp>

namespace crisp::table {

/// Units of a column, by what one of them is in SI.
enum class TimeUnit { s, ms, us, ns };
/// Power of ten of nanoseconds that a unit has.
inline int exponent_of(TimeUnit unit) {
  switch (unit) {
    case TimeUnit::s:
      return 9;
    case TimeUnit::ms:
      return 6;
    case TimeUnit::us:
      return 3;
    case TimeUnit::ns:
      break;
  }
  return 0;
}

enum class LengthUnit { m, cm, mm };

/// Columns of a table, from 1. A row is a scan, or, if `mirror_column` is given,
/// one beam.
struct TableFormat {
  std::optional<int> time_column;  ///< when the row's first beam was fired
  TimeUnit time_unit = TimeUnit::s;
  std::optional<int>
      receipt_column;  ///< when the row was received; the time where there is none, and the reverse
  TimeUnit receipt_unit = TimeUnit::s;
  std::optional<int> counter_column;       ///< the device's own count of its scans
  std::int64_t counter_modulus = 1 << 16;  ///< at which it wraps
  double period = 0;                       ///< [s] nominal, of a scan; needed where there is no time

  std::optional<int> angle_column;  ///< of the actuator; else there is none
  AngleUnit angle_unit = AngleUnit::rad;
  double angle_per_count = 1;  ///< [rad] of AngleUnit::counts

  std::optional<int> range_column;  ///< of the first range; else rows are times alone
  std::optional<int> count_column;  ///< how many ranges the row has; else they go on to its end
  LengthUnit range_unit = LengthUnit::m;
  std::optional<double>
      invalid_from;  ///< ranges so large or larger [range_unit] are codes; so are 0 and less
  std::optional<int> remission_column;  ///< of the first remission, of which there are as many as ranges
  std::optional<int> mirror_column;     ///< reported angle of the one beam of the row
  std::optional<int> laser_column;      ///< index of the laser in the rig, from 0; else all is of the first
};

/// One row, in SI units.
struct TableRow {
  int line = 0;
  std::optional<std::int64_t> time_ns;     ///< [ns] since whatever the table counts from
  std::optional<std::int64_t> receipt_ns;  ///< [ns]
  std::optional<std::int64_t> counter;
  double angle = 0;   ///< [rad]
  double mirror = 0;  ///< [rad]
  std::uint16_t laser = 0;
  std::vector<float> ranges;      ///< [m] 0: no echo
  std::vector<float> remissions;  ///< device's units
};

}  // namespace crisp::table
