// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/model/catalogue.hpp"

namespace crisp {
namespace {

constexpr double kAnyTime = 1e7;  // [s]

EffectParameter instant() {
  return {.name = "at",
          .unit = "s",
          .lower = -kAnyTime,
          .upper = kAnyTime,
          .summary = "when, on the hub's clock since the run's start",
          .shape = true};
}

std::vector<EffectInfo> clocks_and_links() {
  return {
      {.name = "clock.step",
       .summary = "a device's clock jumps",
       .scope = Scope::kDevice,
       .parameters = {{.name = "by", .unit = "s", .lower = -1e4, .upper = 1e4, .summary = "forwards"},
                      instant()},
       .details =
           "The device's time, and no counter, is discontinuous. A 32-bit count of microseconds also jumps, "
           "back by 71.6 min, where it wraps; that is no step, and always simulated."},
      {.name = "latency.step",
       .summary = "the shortest way of a device's telegrams to the hub becomes another",
       .scope = Scope::kDevice,
       .parameters = {{.name = "by", .unit = "s", .lower = -10, .upper = 10, .summary = "later"}, instant()},
       .details =
           "The lower envelope of receipt less device time steps, the device's time does not. Milliseconds, "
           "where a switch or a driver queues from then on."},
      {.name = "latency.jitter",
       .summary = "a device's telegrams are delayed by more or less than those of others",
       .scope = Scope::kDevice,
       .parameters = {{.name = "mean",
                       .unit = "s",
                       .lower = 0,
                       .upper = 10,
                       .summary = "of the delays beyond the shortest; 0: that of its kind of link"},
                      {.name = "shape",
                       .unit = "1",
                       .lower = 0.1,
                       .upper = 10,
                       .neutral = 1,
                       .summary = "of Weibull's law, which they follow; 1: exponential, below: a longer tail",
                       .shape = true}},
       .details =
           "Delays of which 95 % are below q times their median have the shape ln(ln 20 / ln 2) / ln q. A "
           "real "
           "LMS111: a mean of 0.1 ms, a shape of 0.90; an ESP32 over Wi-Fi: 45 to 230 ms, 0.87 to 1.6."},
      {.name = "latency.bursts",
       .summary = "scans that were taken evenly are held back and handed on several at a time",
       .scope = Scope::kDevice,
       .parameters = {{.name = "together",
                       .unit = "1",
                       .lower = 0,
                       .upper = 1,
                       .summary = "share of the scans that come together with the one before"},
                      {.name = "interval",
                       .unit = "s",
                       .lower = 0,
                       .upper = 10,
                       .neutral = 0.02,
                       .summary = "mean time between two scans, as they were taken",
                       .shape = true},
                      {.name = "wait",
                       .unit = "s",
                       .lower = 0,
                       .upper = 10,
                       .summary = "standard deviation of receipt less stamp"}},
       .details =
           "Seen in a recording of 2004 whose host stored several scans of a SICK LMS at a time: 56 % of "
           "them "
           "came with the one before, up to 0.48 s late. The laser's own count of scans, mapped to the hub "
           "by the "
           "lower envelope, is then the model of their times. Simulated as a link that stalls again and "
           "again, "
           "as often and as long as makes so many come together and wait so long."}};
}

std::vector<EffectInfo> mirrors() {
  return {
      {.name = "mirror.interleave",
       .summary = "kinds of scans take turns, whose beams point a part of a step apart",
       .scope = Scope::kLaser,
       .parameters = {{.name = "shift",
                       .unit = "rad",
                       .lower = -0.1,
                       .upper = 0.1,
                       .summary = "by which the beams of one kind point further than those of the others"},
                      {.name = "period",
                       .unit = "1",
                       .lower = 0,
                       .upper = 64,
                       .summary = "scans after which they are alike again",
                       .shape = true},
                      {.name = "kind",
                       .unit = "1",
                       .lower = 0,
                       .upper = 63,
                       .summary = "which of them it is: number of the scan modulo the period",
                       .shape = true}},
       .details = "A laser that makes half degrees of a mirror that fires every degree: every other turn "
                  "goes between. A real SICK LMS: 0.500 ± 0.013 steps. Once beams are angles and times, "
                  "nothing shows which scan they were of."},
      {.name = "mirror.wander",
       .summary =
           "a laser's mirror turns faster and slower by turns of seconds, more than those of others or less",
       .scope = Scope::kLaser,
       .parameters = {{.name = "rms",
                       .unit = "1",
                       .lower = 0,
                       .upper = 0.1,
                       .summary = "of slow changes of its period, as a share of it; 0: as its kind does"}},
       .details = "A real LMS111: 0.11 % within 3.4 s. Clock stages follow it by the scans' stamps."}};
}

std::vector<EffectInfo> noises() {
  return {
      {.name = "noise.normal",
       .summary = "a laser's noise is larger or smaller than that of others",
       .scope = Scope::kLaser,
       .parameters = {{.name = "sigma",
                       .unit = "m",
                       .lower = 0,
                       .upper = 1,
                       .summary = "standard deviation of a range; 0: that of its kind"}},
       .details =
           "The data sheet of the LMS-151 has 12 mm; a real LMS111 scattered by 5.3 mm about either of "
           "its two values."},
      {.name = "noise.range_dependent",
       .summary = "a laser's noise grows with the range",
       .scope = Scope::kLaser,
       .parameters = {{.name = "slope",
                       .unit = "1",
                       .lower = 0,
                       .upper = 0.1,
                       .summary = "standard deviation a metre of range, far away"}},
       .details = "`σ(r) = √(σ² + (slope r)²)`. The LMS-151's 12 mm typical and 20 mm at most are a slope of "
                  "8e-4 at "
                  "20 m."},
      {.name = "noise.incidence_dependent",
       .summary = "a laser's noise grows where its beams graze",
       .scope = Scope::kLaser,
       .parameters = {{.name = "spread",
                       .unit = "m",
                       .lower = 0,
                       .upper = 1,
                       .summary = "standard deviation that an incidence of 45° adds"}},
       .details =
           "The variance grows by `(spread tan β)²`: on a slope the far side of the spot answers later than "
           "the near one, and the echo is stretched. Beams that graze count as met at 84°, where tan β is "
           "9.95. A Velodyne VLP-16 in a small room: 3.8 mm."},
      {.name = "noise.remission_dependent",
       .summary = "a laser's noise grows where echoes are weak",
       .scope = Scope::kLaser,
       .parameters = {{.name = "jitter",
                       .unit = "m",
                       .lower = 0,
                       .upper = 100,
                       .summary = "standard deviation that an echo of remission 1 adds"}},
       .details =
           "The variance grows by `jitter² / I`, where I is the remission in the device's units: n photons "
           "time an echo √n times better than one. Less than 1 counts as 1. Of the powers of I this one "
           "comes "
           "within an eighth of the best gain in likelihood on each of three real lasers: a VLP-16 (15 mm) "
           "would rather have 1/√I, a TiM781S and an LMS511 1/I²."},
      {.name = "noise.heavy_tail",
       .summary = "some of a laser's ranges are much noisier than the others",
       .scope = Scope::kLaser,
       .parameters = {{.name = "share", .unit = "1", .lower = 0, .upper = 1, .summary = "of the ranges"},
                      {.name = "scale",
                       .unit = "1",
                       .lower = 1,
                       .upper = 1e3,
                       .neutral = 5,
                       .summary = "how many times larger their standard deviation is",
                       .shape = true}},
       .details =
           "A mixture of two normal distributions (Tukey's contaminated one): with probability `share` the "
           "noise is `scale` times as large."},
      {.name = "noise.mixed_pixels",
       .summary = "at an edge a laser reports ranges between what is before and behind it",
       .scope = Scope::kLaser,
       .parameters = {{.name = "divergence",
                       .unit = "rad",
                       .lower = 0,
                       .upper = 0.1,
                       .summary = "diameter of the spot, by which it grows a metre of range"},
                      {.name = "aperture",
                       .unit = "m",
                       .lower = 0,
                       .upper = 0.1,
                       .summary = "diameter of the spot at the laser"},
                      {.name = "merge",
                       .unit = "m",
                       .lower = 0,
                       .upper = 10,
                       .neutral = 1,
                       .summary = "echoes no further apart than that become one",
                       .shape = true}},
       .details =
           "The spot of an LMS-151 is about 14 mrad · r + 8 mm wide. Seven rays stand for it; what they meet "
           "counts by the light that comes back. Echoes within `merge` of that of the middle are averaged "
           "with it; where those beyond are stronger together, they are reported in its place."},
      {.name = "noise.two_peaks",
       .summary = "a laser's ranges scatter about two values",
       .scope = Scope::kLaser,
       .parameters = {{.name = "separation", .unit = "m", .lower = 0, .upper = 0.5, .summary = "of the two"},
                      {.name = "least",
                       .unit = "1",
                       .lower = 0,
                       .upper = 1,
                       .neutral = 0.2,
                       .summary = "smallest weight of the farther one",
                       .shape = true},
                      {.name = "most",
                       .unit = "1",
                       .lower = 0,
                       .upper = 1,
                       .neutral = 0.9,
                       .summary = "largest weight of it",
                       .shape = true}},
       .details =
           "Each beam of a laser has a weight of its own, drawn evenly, that stays. Half of the separation "
           "is "
           "added or taken away. Real LMS1xx: 13.5 to 16.7 mm apart, 4 to 6 mm of noise each, weights 0.2 to "
           "0.9."},
      {.name = "noise.quantisation",
       .summary = "a laser's ranges are multiples of a step",
       .scope = Scope::kLaser,
       .parameters =
           {{.name = "step", .unit = "m", .lower = 0, .upper = 1, .summary = "0: that of the telegram"}},
       .details = "A comb in the distribution of ranges. Telegrams of LMS1xx have 1 mm."}};
}

std::vector<EffectInfo> encoders() {
  return {
      {.name = "encoder.slip",
       .summary = "the encoder's count steps against the plate, for good",
       .scope = Scope::kPlate,
       .parameters = {},
       .details =
           "A coupling slips, or counts get lost or come twice: everything that is measured afterwards is "
           "turned by the same angle. `diagnose.encoder` estimates by how much (`by`) and when (`at`); it is "
           "not simulated."}};
}

std::vector<EffectInfo> scenes() {
  return {{.name = "scene.moving",
           .summary = "something moves while it is recorded",
           .scope = Scope::kScene,
           .parameters = {},
           .details =
               "A region disagrees with itself at different times. What moves, and how, is written in the "
               "scene, as a `walk` of one of its things: `scene: people`, or a `scene_file`."}};
}

}  // namespace

const std::vector<EffectInfo>& effects_beyond_the_chain() {
  static const std::vector<EffectInfo> kEffects = [] {
    std::vector<EffectInfo> all = clocks_and_links();
    for (auto& effect : noises()) all.push_back(std::move(effect));
    for (auto& effect : mirrors()) all.push_back(std::move(effect));
    for (auto& effect : encoders()) all.push_back(std::move(effect));
    for (auto& effect : scenes()) all.push_back(std::move(effect));
    return all;
  }();
  return kEffects;
}

}  // namespace crisp
