// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "pipeline/data/scan.hpp"
#include "plugins/diagnose/moved.hpp"
#include "plugins/diagnose/noise_law.hpp"

namespace crisp {

/// Why scans say nothing of the noise.
struct NothingSaid {
  std::string why;
};

/// Whether a plate turned: a laser on it does not stand still, however slowly its ranges change.
class PlateRest {
 public:
  void add(const PlateReading& reading);
  bool turned() const;

 private:
  std::optional<std::uint32_t> first_;  // [encoder steps]
  std::int32_t least_ = 0, most_ = 0;   // since then
};

/// The scans of one laser that stands still: the same beams again and again.
class AtRest {
 public:
  /// A scan with another number of beams than the first is left out.
  void add(const Scan& scan);
  std::size_t scans() const { return receipt_ns_.size(); }

  /// By how much each range is off the mean of its beam. Beams that seldom come back, and those along edges,
  /// are left out: those that scatter by more than 3 cm.
  ///
  /// @param leave_out  beams that do not count besides; empty: none
  /// @return  why they say nothing: there are too few scans, hardly a beam came back, or hardly one stays the
  ///          same, as the laser, or all before it, moves
  std::variant<RangeErrors, NothingSaid> errors(const std::vector<bool>& leave_out = {}) const;

  /// The shots of such beams that are off their median by more than 3 cm, and by far more than they scatter.
  /// What befell most beams at once is no thing that moved.
  FarShots far_shots() const;

  std::int64_t receipt_ns(std::size_t scan) const { return receipt_ns_[scan]; }
  std::size_t left_out() const { return left_out_; }

 private:
  /// Scans in which a beam came back; none if that was seldom.
  std::vector<std::size_t> shots_of(std::size_t beam) const;
  double range(std::size_t scan, std::size_t beam) const { return double{ranges_[scan * beams_ + beam]}; }

  std::size_t beams_ = 0;
  std::vector<float> ranges_;      // [m] scan by scan
  std::vector<float> remissions_;  // device's units, likewise; empty where a scan had none
  std::vector<std::int64_t> receipt_ns_;
  std::size_t left_out_ = 0;
};

}  // namespace crisp
