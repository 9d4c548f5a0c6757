// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pipeline/data/scan.hpp"

namespace crisp {

/// Requested settings of a laser; absent ones stay unchanged.
struct SickConfiguration {
  std::optional<double> frequency;   ///< [Hz] of the mirror
  std::optional<double> resolution;  ///< [rad] from beam to beam
  std::vector<double> output_range;  ///< [rad] first and last angle, as the device reports them; or empty
  std::optional<bool> remission;     ///< whether remissions are sent
  bool ntp_off = false;              ///< the device's clock is not to be set over the network

  bool sets_mirror() const { return frequency || resolution; }
  bool is_empty() const { return !sets_mirror() && output_range.empty() && !remission && !ntp_off; }
};

/// @throws Error if the range is not two ascending angles within a turn
void check(const SickConfiguration& configuration);

/// Difference between a scan and the requested settings, in words; or "". A laser's reported settings may
/// differ from its measurement, so that the scan is decisive.
std::string difference(const SickConfiguration& requested, const Scan& scan);

}  // namespace crisp
