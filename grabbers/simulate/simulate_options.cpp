// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/scenes.hpp"
#include "grabbers/simulate/simulate_stage.hpp"

namespace crisp {

void SimulateStage::describe(Description& d) {
  d.name("grabber.simulate").summary("simulates a scanner in a known scene, telegrams, clocks and all");
  d.details(
      "Gives what the hub would have received, in the order of receipt. What is hidden in it (the true "
      "calibration, the clocks, the delays) is drawn from the seed and written to `truth`, which is a "
      "calibration that `assemble.deskew` can use. The same seed gives the same bytes.\n\n"
      "Delays are chosen so that each laser has exactly its true η: the plate's minimum delay less the "
      "laser's. Shares are between 0 and 1.");
  d.gives<Scan>().gives<PlateReading>();
  describe_scanner(d);
  describe_truth(d);
  describe_plate(d);
  describe_lasers(d);
  describe_stamps(d);
  describe_links(d);
  describe_faults(d);
}

void SimulateStage::describe_scanner(Description& d) {
  using S = SimulateStage;
  d.option("scene", &S::scene_, "what stands around the scanner").choices({"office", "hall", "street"});
  d.option("scene_file", &S::scene_file_, "a scene of your own in YAML, in place of `scene`");
  d.option("duration", &S::scanner, &ScannerSettings::duration, "how long to record")
      .unit("s")
      .range(0.01, 1e5);
  d.option("seed", &S::seed_, "of all that is drawn at random; auto: the run's");
  d.option("capture", &S::capture_file_, "pcap file to write what the network would have carried to");
  d.option("truth", &S::truth_file_, "file to write the true calibration, clocks and delays to");
}

void SimulateStage::describe_truth(Description& d) {
  using S = SimulateStage;
  d.option("calibration", &S::calibration_file_,
           "the true calibration; without one it is drawn around nominal");
  d.option("tau_off", &S::departures_, &Departures::tau, "largest departure of a drawn τ from nominal")
      .unit("m")
      .range(0, 1);
  d.option("alpha_off", &S::departures_, &Departures::alpha, "largest departure of a drawn α from nominal")
      .unit("rad")
      .range(0, 3.2);
  d.option("lambda_off", &S::departures_, &Departures::lambda,
           "largest departure of a drawn λ from nominal; the first laser's is the gauge and stays")
      .unit("rad")
      .range(0, 3.2);
  d.option("eta_off", &S::departures_, &Departures::eta, "largest departure of a drawn η from nominal")
      .unit("s")
      .range(0, 1);
  d.option("effects", &S::effects_,
           "terms of the sensor model to put into the truth: `laser2.mirror.cone.kappa=0.3deg`; without an "
           "owner, into every laser or the plate, as the term is of");
}

void SimulateStage::describe_plate(Description& d) {
  using S = SimulateStage;
  d.option("motion", &S::motion, &MotionSettings::kind, "how the plate turns")
      .choices({{"constant", MotionKind::constant},
                {"varying", MotionKind::varying},
                {"reversal", MotionKind::reversal},
                {"stop_and_go", MotionKind::stop_and_go}});
  d.option("min_rate", &S::motion, &MotionSettings::min_rate, "slowest rate of a varying motion")
      .unit("Hz")
      .range(-50, 50);
  d.option("max_rate", &S::motion, &MotionSettings::max_rate, "fastest rate, or the only one")
      .unit("Hz")
      .range(-50, 50);
  d.option("change_time", &S::motion, &MotionSettings::change_time, "how long a change of the rate takes")
      .unit("s")
      .range(0.01, 1e4);
  d.option("hold_time", &S::motion, &MotionSettings::hold_time,
           "how long reversal and stop_and_go hold a rate")
      .unit("s")
      .range(0, 1e4);
  d.option("plate_frequency", &S::scanner, &ScannerSettings::plate_frequency, "encoder readings a second")
      .unit("Hz")
      .range(1, 1e5);
}

void SimulateStage::describe_lasers(Description& d) {
  using S = SimulateStage;
  d.option("sigma", &S::range, &RangeSettings::sigma, "standard deviation of the ranges' noise")
      .unit("m")
      .range(0, 10);
  d.option("quantum", &S::range, &RangeSettings::quantum, "step of the ranges; telegrams have 1 mm at best")
      .unit("m")
      .range(0, 1);
  d.option("reach", &S::range, &RangeSettings::max_distance, "nothing comes back from beyond")
      .unit("m")
      .range(0.1, 65);
  d.option("first_angle", &S::field, &FieldOfView::first, "reported angle of the first beam").unit("rad");
  d.option("last_angle", &S::field, &FieldOfView::last, "reported angle of the last beam").unit("rad");
  d.option("step", &S::field, &FieldOfView::step, "angle between beams").unit("rad").range(1e-4, 1);
  d.option("mirror_frequency", &S::mirror, &MirrorSettings::frequency, "nominal rate of the mirrors")
      .unit("Hz")
      .range(1, 1000);
  d.option("mirror_slowest", &S::mirror, &MirrorSettings::slowest,
           "each mirror's mean period is drawn: up to this share longer than nominal")
      .unit("1")
      .range(0, 0.1);
  d.option("mirror_wander", &S::mirror, &MirrorSettings::wander, "largest slow departure of the period")
      .unit("1")
      .range(0, 0.1);
  d.option("mirror_jitter", &S::mirror, &MirrorSettings::jitter, "standard deviation of each single period")
      .unit("1")
      .range(0, 0.01);
}

void SimulateStage::describe_stamps(Description& d) {
  using S = SimulateStage;
  d.option("language", &S::settings_, &RecordingSettings::telegrams, &TelegramSettings::language,
           "CoLa-A or CoLa-B")
      .choices({{"A", ColaLanguage::A}, {"B", ColaLanguage::B}});
  d.option("remission", &S::settings_, &RecordingSettings::telegrams, &TelegramSettings::remission,
           "whether telegrams carry remissions")
      .choices({{"none", RemissionChannel::none},
                {"8bit", RemissionChannel::bits8},
                {"16bit", RemissionChannel::bits16}});
  d.option("handover", &S::settings_, &RecordingSettings::telegrams, &TelegramSettings::handover,
           "from the end of the mirror's turn to the transmission stamp")
      .unit("s")
      .range(0, 1);
  d.option("handover_jitter", &S::settings_, &RecordingSettings::telegrams,
           &TelegramSettings::handover_jitter, "standard deviation of it")
      .unit("s")
      .range(0, 1);
  d.option("settling_scans", &S::settings_, &RecordingSettings::telegrams, &TelegramSettings::settling_scans,
           "so many scans after a start say that the motor is not at speed");
  d.option("stamp_lags", &S::settings_, &RecordingSettings::stamp_lags,
           "how much later than the rig says each laser stamps its scans; empty: not at all")
      .unit("s")
      .range(-1, 1);
  d.option("clock_skew", &S::settings_, &RecordingSettings::clocks, &ClockSettings::skew,
           "largest skew of a device's clock")
      .unit("1")
      .range(0, 0.01);
  d.option("clock_drift", &S::settings_, &RecordingSettings::clocks, &ClockSettings::drift,
           "largest growth of the skew in a second (5 ppm an hour are 1.4e-9)")
      .range(0, 1e-5);
}

void SimulateStage::describe_links(Description& d) {
  using S = SimulateStage;
  const auto describe_link = [&d](const std::string& who, LinkSettings RecordingSettings::*link) {
    d.option(who + "_delay", &S::settings_, link, &LinkSettings::minimum, "shortest delay of a telegram")
        .unit("s")
        .range(0, 10);
    d.option(who + "_jitter", &S::settings_, link, &LinkSettings::jitter,
             "mean of the exponentially distributed delay beyond that")
        .unit("s")
        .range(0, 10);
    d.option(who + "_stall_rate", &S::settings_, link, &LinkSettings::stall_rate,
             "how often the link stalls: what is sent meanwhile arrives in a burst")
        .unit("Hz")
        .range(0, 100);
    d.option(who + "_stall_time", &S::settings_, link, &LinkSettings::stall_time, "mean duration of a stall")
        .unit("s")
        .range(0, 100);
  };
  describe_link("laser", &RecordingSettings::laser_link);
  describe_link("plate", &RecordingSettings::plate_link);
}

void SimulateStage::describe_faults(Description& d) {
  using S = SimulateStage;
  d.option("lost_scans", &S::settings_, &RecordingSettings::faults, &FaultSettings::lost_scans,
           "share of the scan telegrams that never arrive")
      .range(0, 1);
  d.option("lost_readings", &S::settings_, &RecordingSettings::faults, &FaultSettings::lost_readings,
           "share of the plate's readings that never arrive")
      .range(0, 1);
  d.option("silences", &S::silences_, "when a device says nothing: `laser2@3s+1s` for a second from 3 s on");
  d.option("restarts", &S::restarts_, "when a device starts again, its clock at zero: `laser1@5s`");
  d.option("lost_frames", &S::wire_faults_, &WireFaults::lost, "share of the frames that the capture lacks")
      .range(0, 1);
  d.option("repeated_frames", &S::wire_faults_, &WireFaults::repeated,
           "share of the frames that the capture holds twice")
      .range(0, 1);
  d.option("damaged_frames", &S::wire_faults_, &WireFaults::damaged,
           "share of the capture's frames with a flipped bit")
      .range(0, 1);
}

}  // namespace crisp
