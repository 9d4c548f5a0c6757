// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "pipeline/clocks/forward_step.hpp"
#include "plugins/clock/aligner.hpp"
#include "plugins/clock/received.hpp"

namespace crisp {

/// From all that was recorded to measurements: for each stretch of time first the plate's trajectory, then
/// all measurements in it, one scan after the other in the order of their beginnings over all lasers.
///
/// Stamps are fitted window by window (see FittedClock), and what lies between the middles of two windows is
/// handed out as soon as the second is fitted, so that memory holds two windows and not the recording. A
/// recording shorter than one and a half windows has one line and is handed out in one piece. The automatic
/// window is 60 s, and doubles, up to 240 s, while delays are so rough that they leave a line less certain
/// than the drift over the window.
///
/// After a pause of all devices (kPause) another recording begins, which has nothing in common with the one
/// before it but the epoch. Where the devices' clocks ran on, the hub's clock was set forward: that is
/// reported as its step, taken out of all receipts after it, and the recording goes on.
class ClockAligner final : public Aligner {
 public:
  ClockAligner(const Rig& rig, const AlignmentSettings& settings, AlignmentSink sink);

  void add(std::shared_ptr<const Scan> scan) override;
  void add(const PlateReading& reading) override;
  AlignmentReport finish() override;

 private:
  void receive(Received item);
  void judge_gap();
  void pass(const Received& item);
  double arrive(std::int64_t receipt_ns);
  void end_recording();
  void advance_windows();
  void take_out_hub_deviation();
  void take_out_steps();
  bool is_too_short() const;
  void settle(double begin, double end);
  void hand_out(double limit);
  bool idle() const;

  AlignmentSettings settings_;
  AlignmentSink sink_;
  HubTimings tracks_;
  AlignmentReport report_;  ///< of recordings that have ended, and the hub's clock
  ForwardStep forward_step_;
  std::int64_t stepped_ns_ = 0;  ///< by how much the hub's clock was set forward, in all
  std::vector<Received> held_;   ///< after a gap in the receipts, until its cause is known
  double begin_ = 0;             ///< [s since the epoch] of the window that is being filled
  double length_;                ///< [s] of it
};

}  // namespace crisp
