// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <crisp/measurements.hpp>
#include <crisp/plate_trajectory.hpp>
#include <crisp/rig.hpp>
#include <crisp/scan.hpp>

#include "grabbers/table/actuator_angles.hpp"
#include "grabbers/table/table_format.hpp"

namespace crisp::table {

/// Motion of the actuator during a scan.
enum class ActuatorMotion {
  moves,   ///< the row's angle is that at its time
  stands,  ///< it has the row's angle from the first beam to the last, and steps in between
};

/// Settings that a table's rows do not contain.
struct TableScanSettings {
  double start_angle = 0;    ///< [rad] reported angle of the first beam
  double angle_step = 0;     ///< [rad]
  double beam_interval = 0;  ///< [s] between two beams of a row
  ActuatorMotion actuator = ActuatorMotion::moves;
  double max_gap = 1;  ///< [s] longest silence of the angles to interpolate across
};

/// A scan with the reading of the actuator that stood in its row.
struct TableScan {
  std::shared_ptr<const Scan> scan;     ///< null for a row of one beam
  std::optional<PlateReading> reading;  ///< nothing where the row before has one of the same instant
};

/// Converts rows: scans and readings as they were received, for a clock stage, and
/// measurements with the actuator's angle on the table's own time, where laser and actuator share one clock.
class TableItems {
 public:
  /// @param rig  its plate is the actuator: angles are rounded to its encoder's steps
  TableItems(const TableFormat& format, const TableScanSettings& settings, Rig rig);

  /// The time of the next row, by its stamp or its count. Nothing for a row that is out of order, repeated,
  /// or of a laser that the rig does not have, which is counted.
  std::optional<std::int64_t> admit(const TableRow& row);
  /// Adds a row that was just admitted. @param time_ns  the result of admit()
  TableScan add(const TableRow& row, std::int64_t time_ns);
  /// Both, for those who want every row.
  std::optional<TableScan> add(const TableRow& row);

  /// The trajectory of all rows so far. @throws Error if there are fewer than two angles at different times
  PlateTrajectory trajectory() const;
  /// The measurements of the rows so far, a scan each (or all consecutive beams of a laser); forgets them.
  std::vector<std::shared_ptr<const Measurements>> take_measurements();
  /// The same, of those that were over at this time [s since the epoch] and came before all that were not.
  std::vector<std::shared_ptr<const Measurements>> take_measurements_until(double time);
  /// [s since the epoch] By which half of what take_measurements() would give was over.
  double middle_time() const;
  /// Angles before this time [s since the epoch] are no longer part of trajectory().
  void forget_angles_before(double time);
  std::uint64_t beams() const { return beam_count_; }  ///< taken so far
  std::uint64_t beams_held() const {
    return beam_count_ - forgotten_;
  }  ///< that take_measurements() would give

  const std::map<std::string, std::uint64_t>& losses() const { return losses_; }
  /// Line of the first row that is earlier than the one before; 0: there is none.
  int first_early_line() const { return first_early_line_; }
  std::uint64_t rows() const { return rows_; }  ///< taken so far
  /// Rows that by their own time began before the last beam of the row before, of the same laser, was fired.
  /// Angles that are a turn and a half or more from the one before: no actuator steps so far.
  std::uint64_t large_steps() const { return large_steps_; }
  std::uint64_t overlapping() const { return overlapping_; }

 private:
  /// Turns of the mirror since the first row; nothing for a row whose counter is that of the row before.
  std::optional<std::int64_t> turn_of(const TableRow& row) const;
  void note_step(double reported);
  void note_end(const TableRow& row, double time);
  std::int64_t time_of(const TableRow& row, std::int64_t turn) const;
  std::shared_ptr<const Scan> scan_of(const TableRow& row, std::int64_t time_ns) const;
  void add_beams(const TableRow& row, double time);
  double seconds(std::int64_t ns) const;

  TableFormat format_;
  TableScanSettings settings_;
  Rig rig_;
  std::uint64_t rows_ = 0;
  std::uint64_t overlapping_ = 0;
  std::uint64_t large_steps_ = 0;
  std::optional<double> last_reported_;  ///< [rad]
  std::vector<double> ends_;             ///< [s] last beam of each laser so far
  int first_early_line_ = 0;
  std::uint16_t readings_ = 0;  ///< wraps, as a device's counter does
  std::optional<std::int64_t> last_counter_;
  std::int64_t turn_ = -1;  ///< of the row admitted last: the device's count, unwrapped, or the row's number
  std::optional<std::int64_t> last_ns_;
  std::int64_t epoch_ns_ = 0;
  std::optional<std::int64_t> last_reading_us_;
  ActuatorAngles angles_;
  std::vector<std::shared_ptr<Measurements>> beams_;
  std::uint64_t beam_count_ = 0;
  std::uint64_t forgotten_ = 0;  ///< beams
  std::map<std::string, std::uint64_t> losses_;
};

}  // namespace crisp::table
