// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include <crisp/alignment.hpp>
#include <crisp/rig.hpp>

namespace crisp {

/// From all that was recorded to measurements: for each stretch of time first the plate's trajectory, then
/// all measurements in it, one scan after the other in the order of their beginnings over all lasers.
///
/// Stamps are fitted window by window (see WindowedClockFit), and what lies between the middles of two
/// windows is handed out as soon as the second is fitted, so that memory holds two windows and not the
/// recording. A recording shorter than one and a half windows has one line and is handed out in one piece.
/// The automatic window is 60 s, and doubles, up to 240 s, while delays are so rough that they leave a line
/// less certain than the drift over the window.
///
/// After a pause of all devices (kPause) another recording begins, which has nothing in common with the one
/// before it but the epoch. Where the devices' clocks ran on, the hub's clock was set forward: that is
/// reported as its step, taken out of all receipts after it, and the recording goes on.
class ClockAligner final : public Aligner {
 public:
  /// @param rig   whose lasers and plate the scans and readings come from
  /// @param sink  receives the results while the recording is read
  /// @throws Error  if the rig gives no counts a revolution
  ClockAligner(const Rig& rig, const AlignmentSettings& settings, AlignmentSink sink);
  ~ClockAligner() override;

  void add(std::shared_ptr<const Scan> scan) override;
  /// @throws Error if the plate's clock cannot be used at all
  void add(const PlateReading& reading) override;
  AlignmentReport finish() override;

 private:
  class Windows;
  std::unique_ptr<Windows> windows_;
};

}  // namespace crisp
