// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <crisp/context.hpp>
#include <crisp/findings.hpp>
#include <crisp/stage.hpp>

#include "pipeline/clocks/pauses.hpp"
#include "plugins/diagnose/clocks/clock_departure.hpp"

namespace crisp::diagnose {

/// Stage diagnose.clocks: tests clocks, links and mirrors by the telegrams' timestamps.
class DiagnoseClocksStage final : public Stage {
 public:
  static void describe(StageDescription<DiagnoseClocksStage>& d);
  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  struct Device {
    std::string name;
    StampTrack telegrams;       // send times
    StampTrack passes;          // of the mirror's index
    double nominal_period = 0;  // [s]
    bool timed = true;          // its own clock timed its scans, so that the mirror's period is measured

    bool has_mirror() const { return !timed || !passes.stamps().empty(); }
  };
  Device& device(std::size_t index, const Rig& rig);
  void arrive(std::int64_t receipt_ns);
  void end_recording();
  double hub_time(const StampTrack& track) const;
  void take_out_hub_deviation(Context& context);
  void add_clock(const Device& device, std::size_t tests, Context& context, Findings& all) const;
  void add_mirror(const Device& device, const MirrorFacts& facts, std::uint64_t seed, Findings& all) const;

  bool nominal_mirrors_ = false;
  std::optional<std::filesystem::path> folder_;
  std::vector<Device> devices_;           // the lasers of the rig, then the plate, in the current recording
  std::vector<Device> longest_;           // in the recording with the most stamps so far
  std::optional<std::int64_t> first_ns_;  // first receipt time of any device
  clocks::Pauses pauses_;
  Findings all_;  // including those of earlier stages
};

}  // namespace crisp::diagnose
