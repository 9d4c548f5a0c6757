// SPDX-License-Identifier: BSD-3-Clause
#include <crisp/effect_catalogue.hpp>

namespace crisp {
namespace {

constexpr double kAnyTime = 1e7;  // [s]

EffectParameter instant() {
  return {.name = "at",
          .unit = "s",
          .lower = -kAnyTime,
          .upper = kAnyTime,
          .summary = "time of the step, on the hub's clock since the run's start",
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
           "The device's time is discontinuous, its counters are not. The wrap of a 32-bit count of microseconds, back by 71.6 min, is no step, and always simulated."},
      {.name = "latency.step",
       .summary = "the minimum delay of a device's telegrams to the hub steps",
       .scope = Scope::kDevice,
       .parameters = {{.name = "by", .unit = "s", .lower = -10, .upper = 10, .summary = "later"}, instant()},
       .details =
           "The lower envelope of receipt less device time steps, the device's time does not. Milliseconds, if a switch or a driver starts queueing."},
      {.name = "latency.jitter",
       .summary = "a device's telegrams have their own distribution of delays",
       .scope = Scope::kDevice,
       .parameters = {{.name = "mean",
                       .unit = "s",
                       .lower = 0,
                       .upper = 10,
                       .summary = "median of the delays beyond the shortest; 0: the link's default"},
                      {.name = "shape",
                       .unit = "1",
                       .lower = 0.1,
                       .upper = 10,
                       .neutral = 1,
                       .summary = "shape of their Weibull distribution; 1: exponential, below: a longer tail",
                       .shape = true}},
       .details =
           "Delays of which 95 % are below q times their median have the shape ln(ln 20 / ln 2) / ln q. A real LMS111: a mean of 0.1 ms, a shape of 0.90; an ESP32 over Wi-Fi: 45 to 230 ms, 0.87 to 1.6."},
      {.name = "latency.bursts",
       .summary = "evenly taken scans are held back and passed on in bursts",
       .scope = Scope::kDevice,
       .parameters = {{.name = "together",
                       .unit = "1",
                       .lower = 0,
                       .upper = 1,
                       .summary = "fraction of the scans that arrive together with the one before"},
                      {.name = "interval",
                       .unit = "s",
                       .lower = 0,
                       .upper = 10,
                       .neutral = 0.02,
                       .summary = "mean time between two scans as they were taken",
                       .shape = true},
                      {.name = "wait",
                       .unit = "s",
                       .lower = 0,
                       .upper = 10,
                       .summary = "standard deviation of receipt less stamp"}},
       .details =
           "Seen in a recording of 2004 whose host stored several scans of a SICK LMS at a time: 56 % of them came with the one before, up to 0.48 s late. The laser's own count of scans, mapped to the hub by the lower envelope, is then the model of their times. Simulated as a link that stalls repeatedly, with the rate and duration that give this fraction and this wait."}};
}

std::vector<EffectInfo> mirrors() {
  return {
      {.name = "mirror.interleave",
       .summary = "scan classes alternate, whose beams are offset by a fraction of a step",
       .scope = Scope::kLaser,
       .parameters = {{.name = "shift",
                       .unit = "rad",
                       .lower = -0.1,
                       .upper = 0.1,
                       .summary = "angular offset of one scan class against the others"},
                      {.name = "period",
                       .unit = "1",
                       .lower = 0,
                       .upper = 64,
                       .summary = "period of the scan classes, in scans",
                       .shape = true},
                      {.name = "kind",
                       .unit = "1",
                       .lower = 0,
                       .upper = 63,
                       .summary = "the offset class: number of the scan modulo the period",
                       .shape = true}},
       .details =
           "A laser that interleaves half degrees with a mirror that fires every degree: every other turn is offset. A real SICK LMS: 0.500 ± 0.013 steps. Beams as angles and times do not contain the class of their scan."},
      {.name = "mirror.wander",
       .summary = "a laser's mirror period wanders within seconds",
       .scope = Scope::kLaser,
       .parameters = {{.name = "rms",
                       .unit = "1",
                       .lower = 0,
                       .upper = 0.1,
                       .summary =
                           "RMS of slow changes of its period, relative to it; 0: the device's default"}},
       .details = "A real LMS111: 0.11 % within 3.4 s. Clock stages track it by the scans' stamps."}};
}

std::vector<EffectInfo> noises() {
  return {
      {.name = "noise.normal",
       .summary = "a laser's ranges have their own standard deviation",
       .scope = Scope::kLaser,
       .parameters = {{.name = "sigma",
                       .unit = "m",
                       .lower = 0,
                       .upper = 1,
                       .summary = "standard deviation of a range; 0: the device's default"}},
       .details =
           "The data sheet of the LMS-151 has 12 mm; a real LMS111 had 5.3 mm about either of its two values."},
      {.name = "noise.range_dependent",
       .summary = "a laser's noise grows with the range",
       .scope = Scope::kLaser,
       .parameters = {{.name = "slope",
                       .unit = "1",
                       .lower = 0,
                       .upper = 0.1,
                       .summary = "asymptotic standard deviation per metre of range"}},
       .details =
           "`σ(r) = √(σ² + (slope r)²)`. The LMS-151's 12 mm typical and 20 mm at most are a slope of 8e-4 at 20 m."},
      {.name = "noise.incidence_dependent",
       .summary = "a laser's noise grows with the incidence",
       .scope = Scope::kLaser,
       .parameters = {{.name = "spread",
                       .unit = "m",
                       .lower = 0,
                       .upper = 1,
                       .summary = "standard deviation that an incidence of 45° adds"}},
       .details =
           "The variance grows by `(spread tan β)²`: on a slope the far side of the spot returns later than the near one, which stretches the echo. Grazing incidences are clipped at 84°, where tan β is 9.95. A Velodyne VLP-16 in a small room: 3.8 mm."},
      {.name = "noise.remission_dependent",
       .summary = "a laser's noise grows for weak echoes",
       .scope = Scope::kLaser,
       .parameters = {{.name = "jitter",
                       .unit = "m",
                       .lower = 0,
                       .upper = 100,
                       .summary = "standard deviation that an echo of remission 1 adds"}},
       .details =
           "The variance grows by `jitter² / I`, where I is the remission in the device's units: n photons time an echo √n times better than one. Less than 1 counts as 1. Among the powers of I this one comes within an eighth of the best gain in likelihood on each of three real lasers: the best is 1/√I for a VLP-16 (15 mm), 1/I² for a TiM781S and an LMS511."},
      {.name = "noise.heavy_tail",
       .summary = "some of a laser's ranges are much noisier than the others",
       .scope = Scope::kLaser,
       .parameters = {{.name = "share", .unit = "1", .lower = 0, .upper = 1, .summary = "of the ranges"},
                      {.name = "scale",
                       .unit = "1",
                       .lower = 1,
                       .upper = 1e3,
                       .neutral = 5,
                       .summary = "ratio of the standard deviations",
                       .shape = true}},
       .details =
           "A mixture of two normal distributions (Tukey's contaminated one): with probability `share` the noise is `scale` times as large."},
      {.name = "noise.mixed_pixels",
       .summary = "mixed pixels: at an edge a laser reports ranges between foreground and background",
       .scope = Scope::kLaser,
       .parameters = {{.name = "divergence",
                       .unit = "rad",
                       .lower = 0,
                       .upper = 0.1,
                       .summary = "divergence of the beam: growth of the spot's diameter per metre of range"},
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
                       .summary = "echoes no further apart merge into one",
                       .shape = true}},
       .details =
           "The spot of an LMS-151 is about 14 mrad · r + 8 mm wide. Seven rays sample it, weighted by the returned light. Echoes within `merge` of the central one are averaged with it; if those beyond are stronger together, they are reported instead."},
      {.name = "noise.two_peaks",
       .summary = "a laser's range noise has two peaks",
       .scope = Scope::kLaser,
       .parameters = {{.name = "separation", .unit = "m", .lower = 0, .upper = 0.5, .summary = "of the two"},
                      {.name = "least",
                       .unit = "1",
                       .lower = 0,
                       .upper = 1,
                       .neutral = 0.2,
                       .summary = "smallest weight of the farther peak",
                       .shape = true},
                      {.name = "most",
                       .unit = "1",
                       .lower = 0,
                       .upper = 1,
                       .neutral = 0.9,
                       .summary = "largest weight of it",
                       .shape = true}},
       .details =
           "Each beam of a laser has a fixed weight, drawn uniformly. Half of the separation is added or subtracted. Real LMS1xx: 13.5 to 16.7 mm apart, 4 to 6 mm of noise each, weights 0.2 to 0.9."},
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
       .summary = "the encoder's count steps permanently against the plate",
       .scope = Scope::kPlate,
       .parameters = {},
       .details =
           "A coupling slips, or counts are lost or repeated: all later beams are rotated by the same angle. `diagnose.encoder` estimates by how much (`by`) and when (`at`); it is not simulated."}};
}

std::vector<EffectInfo> scenes() {
  return {
      {.name = "scene.moving",
       .summary = "something moves while it is recorded",
       .scope = Scope::kScene,
       .parameters = {},
       .details =
           "A region of the scene changes over time. The scene defines the motion, as a `walk` of one of its things: `scene: people`, or a `scene_file`."}};
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
