// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>

#include <crisp/measurements.hpp>
#include <crisp/pcd_table.hpp>
#include <crisp/plate_trajectory.hpp>

namespace crisp {

/// Measurements as a PCD table: fields range, mirror_angle, time, plate_angle, laser, beam, remission, and
/// the notes epoch_ns and plate (digest of the trajectory's table). All but plate_angle, φ at `time` (NaN
/// where the readings do not cover it), come back exactly.
PcdTable to_pcd_table(const Measurements& beams, const PlateTrajectory& plate);

/// A trajectory as a PCD table: fields time and angle, one row a reading, and the notes epoch_ns and max_gap;
/// if the encoder's count restarted, the field zero numbers the restarts. The conversion is lossless.
PcdTable to_pcd_table(const PlateTrajectory& plate);

/// Whether the trajectory's table is the one that was written together with the measurements. In files of
/// earlier versions and of other programs, which have no digest, only the epoch is compared.
bool belong_together(const PcdTable& measurements, const PcdTable& trajectory);

/// The file in which the trajectory stands that belongs to a file of measurements: x.pcd → x.plate.pcd.
std::filesystem::path plate_path(const std::filesystem::path& measurements);

/// Measurements that were made of a PCD table.
struct TableMeasurements {
  Measurements beams;          ///< in the order of the table
  std::size_t impossible = 0;  ///< ranges that are not positive, or anything that is not a number: left out
};

/// @throws Error if a field is missing, or a laser or beam is beyond 65535
TableMeasurements measurements_of(const PcdTable& table);

/// @throws Error if a field is missing, a value is not a number, or the times do not ascend
PlateTrajectory trajectory_of(const PcdTable& table);

/// The trajectory made of the measurements' own plate_angle, for where no trajectory was kept: it covers no
/// more than the measurements' times. Turns that the angles leave out (a file with 0 to 2π) are put back.
/// @param max_gap [s] longest silence to interpolate across
/// @throws Error if there is no such field, or not two measurements of different times that have it
PlateTrajectory trajectory_between(const PcdTable& measurements, double max_gap);

}  // namespace crisp
