// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <crisp/scan.hpp>

#include "plugins/diagnose/noise/noise_model.hpp"
#include "plugins/diagnose/scene/moving_objects.hpp"

namespace crisp::diagnose {

/// Reason why the noise cannot be estimated from the scans.
struct InsufficientData {
  std::string why;
};

/// Detects whether the plate turned: a laser on it is not stationary then, however slowly its ranges change.
class PlateStandstill {
 public:
  void add(const PlateReading& reading);
  bool turned() const;

 private:
  std::optional<std::uint32_t> first_;  // [encoder steps]
  std::int32_t least_ = 0, most_ = 0;   // relative to it
};

/// The scans of one stationary laser.
class StationaryScans {
 public:
  /// Adds a scan. One with another number of beams than the first is left out.
  void add(const Scan& scan);
  std::size_t scans() const { return receipt_ns_.size(); }

  /// Range errors about the mean of each beam. Beams with few echoes and beams at edges (standard deviation
  /// above 3 cm) are left out.
  ///
  /// @param leave_out  further beams to leave out; empty: none
  /// @return  the reason instead, if there are too few scans, too few echoes, or too few static beams because
  ///          the laser or the scene moves
  std::variant<RangeErrors, InsufficientData> errors(const std::vector<bool>& leave_out = {}) const;

  /// Shots of the same beams that deviate from their median by more than 3 cm and many standard deviations.
  /// Deviations of most beams at once are excluded: moving objects do not cause them.
  FarShots far_shots() const;

  std::int64_t receipt_ns(std::size_t scan) const { return receipt_ns_[scan]; }
  std::size_t left_out() const { return left_out_; }

 private:
  /// Scans in which the beam has an echo; none if they are few.
  std::vector<std::size_t> shots_of(std::size_t beam) const;
  double range(std::size_t scan, std::size_t beam) const { return double{ranges_[scan * beams_ + beam]}; }

  std::size_t beams_ = 0;
  std::vector<float> ranges_;      // [m] by scan, then beam
  std::vector<float> remissions_;  // device's units, likewise; empty if a scan had none
  std::vector<std::int64_t> receipt_ns_;
  std::size_t left_out_ = 0;
};

}  // namespace crisp::diagnose
