// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <crisp/alignment.hpp>
#include <crisp/calibration.hpp>
#include <crisp/rig.hpp>

namespace crisp {

/// How stamps become hub times while they come in.
struct OnlineSettings {
  double window = 60;          ///< [s] of stamps that a clock's line is fitted to
  double warm_up = 0.5;        ///< [s] of stamps of a device before its line is used
  double margin = 0.06;        ///< [s] by which a trajectory covers more than its scan, as far as it is known
  double plate_timeout = 0.2;  ///< [s] for the encoder readings, after which a scan goes without them
  double least_lag = 0;        ///< [s] of any laser behind the plate: the least η, and
  double greatest_lag =
      0;                  ///< [s] the greatest, so that the readings that a scan is placed by are waited for
  double lag_margin = 0;  ///< [s] margin of lags beyond the calibration
};

/// Default number of stamps on either side that smooth the mirror's motion: of those so far.
inline constexpr unsigned kOnlineMirror = 5;

/// The settings with the lags of a calibration's lasers, and the margin.
OnlineSettings with_lags(OnlineSettings settings, const Calibration& calibration);

/// From scans and readings in the order of receipt to measurements, each scan as soon as the encoder readings
/// cover it. A device's clock is the line below its stamps of the last minute; what was handed out is not
/// corrected when the line becomes better known. So what is handed out depends on the items alone, and their
/// times of receipt: a recording of them gives the same again.
class OnlineAligner final : public Aligner {
 public:
  /// @param alignment  `find`, `drift`, `source`, `plate` and `mirror_half_width` count here
  OnlineAligner(const Rig& rig, const AlignmentSettings& alignment, const OnlineSettings& online,
                AlignmentSink sink);
  ~OnlineAligner() override;

  void add(std::shared_ptr<const Scan> scan) override;
  /// @throws Error if the plate's clock cannot be used at all
  void add(const PlateReading& reading) override;
  AlignmentReport finish() override;

  /// From now on it waits for what these lasers' lags need.
  void set_lags(const Calibration& calibration);
  /// The devices' clocks as they are known now: the lasers in the rig's order, then the plate.
  std::vector<DeviceReport> devices() const;
  double now() const;  ///< [s since the epoch] latest receipt
  /// Scans that wait for the plate.
  std::size_t waiting() const;

 private:
  class Queue;
  std::unique_ptr<Queue> queue_;
};

}  // namespace crisp
