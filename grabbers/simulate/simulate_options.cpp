// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/scenario_options.hpp"
#include "grabbers/simulate/simulate_stage.hpp"

namespace crisp::simulate {

void SimulateStage::describe(Description& d) {
  d.name("grabber.simulate")
      .summary("simulates a scanner in a known scene, with telegrams, clocks and network delays");
  d.details(
      "Gives the hub's received scans and readings, in the order of receipt. The truth (calibration, clocks, delays) is drawn from the seed and written to `truth`, a calibration for `assemble.deskew`. The same seed gives the same bytes.\n\n"
      "Delays are chosen so that each laser has exactly its true η: the plate's minimum delay less the laser's. Shares are between 0 and 1.");
  d.gives<Scan>().gives<PlateReading>();
  describe_scanner(d);
  describe_truth(d, &SimulateStage::hidden_);
  describe_realism(d, &SimulateStage::realism_);
  describe_plate(d);
  describe_lasers(d);
  describe_stamps(d);
  describe_links(d);
  describe_faults(d);
}

void SimulateStage::describe_scanner(Description& d) {
  using S = SimulateStage;
  describe_scene(d, &S::scene_);
  d.option("duration", &S::scanner, &ScannerSettings::duration, "duration of the recording")
      .unit("s")
      .range(0.01, 1e5);
  d.option("start", &S::start_, "the hub's clock at the start, since 1970").unit("s").range(0, 9e9);
  d.option("seed", &S::seed_, "seed of the simulation; auto: the run's");
  d.option("capture", &S::capture_file_, "pcap file for the simulated network traffic").writes();
  d.option("truth", &S::truth_file_, "file for the true calibration, clocks and delays").writes();
}

void SimulateStage::describe_plate(Description& d) {
  using S = SimulateStage;
  describe_motion(d, &S::motion);
  d.group("encoder", "the plate's encoder");
  d.option("encoder.frequency", &S::scanner, &ScannerSettings::plate_frequency, "rate of its readings")
      .unit("Hz")
      .range(1, 1e5);
}

void SimulateStage::describe_lasers(Description& d) {
  using S = SimulateStage;
  describe_field(d, &S::scanner);
  d.option("lasers.sigma", &S::range, &RangeSettings::sigma, "standard deviation of the ranges' noise")
      .unit("m")
      .range(0, 10);
  d.option("lasers.quantum", &S::range, &RangeSettings::quantum,
           "quantization step of the ranges; telegrams have 1 mm at best")
      .unit("m")
      .range(0, 1);
  describe_kinds(d, &S::kinds_);
}

void SimulateStage::describe_stamps(Description& d) {
  using S = SimulateStage;
  d.group("telegrams", "the lasers' telegrams: content, and time of transmission");
  d.option("telegrams.language", &S::settings_, &RecordingSettings::telegrams, &TelegramSettings::language,
           "CoLa-A or CoLa-B")
      .choices({{"A", ColaLanguage::A}, {"B", ColaLanguage::B}});
  d.option("telegrams.remission", &S::settings_, &RecordingSettings::telegrams, &TelegramSettings::remission,
           "whether telegrams carry remissions")
      .choices({{"none", RemissionChannel::none},
                {"8bit", RemissionChannel::bits8},
                {"16bit", RemissionChannel::bits16}});
  d.option("telegrams.handover", &S::settings_, &RecordingSettings::telegrams, &TelegramSettings::handover,
           "delay from the end of the mirror's turn to the transmission stamp")
      .unit("s")
      .range(0, 1);
  d.option("telegrams.handover_jitter", &S::settings_, &RecordingSettings::telegrams,
           &TelegramSettings::handover_jitter, "standard deviation of that delay")
      .unit("s")
      .range(0, 1);
  d.option("telegrams.settling_scans", &S::settings_, &RecordingSettings::telegrams,
           &TelegramSettings::settling_scans,
           "number of scans after a start that are marked as taken before the motor is at speed");
  d.group("clocks", "the devices' clocks");
  d.option("clocks.stamp_lags", &S::settings_, &RecordingSettings::stamp_lags,
           "delay of each laser's scan stamps beyond the rig's offsets; empty: none")
      .unit("s")
      .range(-1, 1);
  d.option("clocks.skew", &S::settings_, &RecordingSettings::clocks, &ClockSettings::skew,
           "largest skew of a device's clock")
      .unit("1")
      .range(0, 0.01);
  d.option("clocks.drift", &S::settings_, &RecordingSettings::clocks, &ClockSettings::drift,
           "largest growth of the skew in a second (5 ppm an hour are 1.4e-9)")
      .range(0, 1e-5);
}

void SimulateStage::describe_links(Description& d) {
  using S = SimulateStage;
  const auto describe_link = [&d](const std::string& who, LinkSettings RecordingSettings::*link) {
    const std::string group = "links." + who;
    d.group(group, "delays of the " + who + "'s telegrams");
    d.option(group + ".delay", &S::settings_, link, &LinkSettings::minimum, "shortest delay of a telegram")
        .unit("s")
        .range(0, 10);
    d.option(group + ".jitter", &S::settings_, link, &LinkSettings::jitter,
             "mean of the exponentially distributed delay beyond that")
        .unit("s")
        .range(0, 10);
    d.option(group + ".stall_rate", &S::settings_, link, &LinkSettings::stall_rate,
             "rate of the link's stalls: telegrams sent meanwhile arrive in a burst")
        .unit("Hz")
        .range(0, 100);
    d.option(group + ".stall_time", &S::settings_, link, &LinkSettings::stall_time,
             "mean duration of a stall")
        .unit("s")
        .range(0, 100);
  };
  describe_link("laser", &RecordingSettings::laser_link);
  describe_link("plate", &RecordingSettings::plate_link);
}

void SimulateStage::describe_faults(Description& d) {
  using S = SimulateStage;
  d.group("faults", "losses, silences, restarts and damage");
  d.option("faults.lost_scans", &S::settings_, &RecordingSettings::faults, &FaultSettings::lost_scans,
           "share of scan telegrams that are lost")
      .range(0, 1);
  d.option("faults.lost_readings", &S::settings_, &RecordingSettings::faults, &FaultSettings::lost_readings,
           "share of encoder readings that are lost")
      .range(0, 1);
  d.option("faults.silences", &S::silences_,
           "silences of devices: `laser2@3s+1s` for one second from 3 s on");
  d.option("faults.restarts", &S::restarts_, "restarts of devices, with the clock at zero: `laser1@5s`");
  d.option("faults.lost_frames", &S::wire_faults_, &WireFaults::lost,
           "share of frames missing from the capture")
      .range(0, 1);
  d.option("faults.repeated_frames", &S::wire_faults_, &WireFaults::repeated,
           "share of frames that the capture holds twice")
      .range(0, 1);
  d.option("faults.damaged_frames", &S::wire_faults_, &WireFaults::damaged,
           "share of frames with a flipped bit")
      .range(0, 1);
}

}  // namespace crisp::simulate
