// SPDX-License-Identifier: BSD-3-Clause
// When a beam was fired, beyond η: what is added to its hub time before the plate is asked where it was.
#include <numbers>

#include "pipeline/model/terms/families.hpp"

namespace crisp {
namespace {

/// The time between beams is not what was taken for it, or was left out altogether.
struct IntraScan final : DifferentiableTerm<IntraScan> {
  const TermInfo& info() const override {
    static const TermInfo kInfo{
        .name = "timing.intra_scan",
        .summary = "the beams of a scan follow each other at another pace than was taken",
        .phase = Phase::kTime,
        .scope = Scope::kLaser,
        .parameters = {{.name = "kappa",
                        .unit = "s",
                        .lower = -1e-3,
                        .upper = 1e-3,
                        .summary = "time to the next beam, beyond what was taken"}},
        .details =
            "`t + κ k` for beam k of its scan, so that φ changes by `ω κ k`. Where the time between beams "
            "is left out altogether, κ is 28 µs at 50 Hz and half a degree, which is 2.7° over a sweep "
            "while the plate turns at 0.5 Hz. At one speed it looks like α.",
        .told_by = "a reversal of the plate, or other rates; the mirror's own stamps"};
    return kInfo;
  }
  template <class T>
  void change(Beam<T>& beam, std::span<const T> p) const {
    beam.time += p[0] * static_cast<double>(beam.number);
  }
};

/// The mirror turns at another rate than was taken, and the angles, which an encoder on the mirror gives, are
/// right: then the times within a turn are stretched.
struct MirrorPeriod final : DifferentiableTerm<MirrorPeriod> {
  const TermInfo& info() const override {
    static const TermInfo kInfo{
        .name = "mirror.period",
        .summary = "a laser's mirror takes longer for a turn than was taken",
        .phase = Phase::kTime,
        .scope = Scope::kLaser,
        .parameters = {{.name = "excess",
                        .unit = "s",
                        .lower = -1e-2,
                        .upper = 1e-2,
                        .summary = "of the period over the one that was taken"}},
        .details =
            "`t + excess θ/2π`: a term for measurements whose times were taken from a nominal period. "
            "Real LMS1xx are 0.57 % slow, 114 µs of 20 ms, and wander by ±0.2 % within seconds. Within one "
            "scan it cannot be told from timing.intra_scan: the stamps of successive scans tell. Simulated "
            "telegrams come from a mirror that does turn so.",
        .told_by = "the mirror's own stamps"};
    return kInfo;
  }
  template <class T>
  void change(Beam<T>& beam, std::span<const T> p) const {
    beam.time += p[0] * (beam.measured_mirror / (2 * std::numbers::pi));
  }
};

/// What is left of a device's clock when its rate was taken to be constant.
struct ClockDrift final : DifferentiableTerm<ClockDrift> {
  const TermInfo& info() const override {
    static const TermInfo kInfo{
        .name = "clock.drift",
        .summary = "the rate of a device's clock changes",
        .phase = Phase::kTime,
        .scope = Scope::kLaser,
        .parameters = {{.name = "skew",
                        .unit = "1",
                        .lower = -0.01,
                        .upper = 0.01,
                        .summary = "hub seconds a device second − 1, beyond what was taken"},
                       {.name = "drift",
                        .unit = "1/s",
                        .lower = -1e-3,
                        .upper = 1e-3,
                        .summary = "by how much the skew grows in a second"}},
        .details =
            "`t + skew t + drift t²/2`, t since the run's epoch: as the cloud sees it, a lag that varies "
            "with time. 20 ppm over 0 to 50 °C; Sheehan, Harrison and Newman lost 90 s in 5 days, 208 ppm. "
            "Simulated telegrams carry the stamps of a clock that does run so.",
        .told_by = "a longer recording",
        .counts_from = CountsFrom::kRunsEpoch};
    return kInfo;
  }
  template <class T>
  void change(Beam<T>& beam, std::span<const T> p) const {
    beam.time += beam.hub_time * (p[0] + p[1] * (beam.hub_time / 2));
  }
};

}  // namespace

void register_timing_terms(TermRegistry& terms) {
  terms.add(std::make_shared<IntraScan>());
  terms.add(std::make_shared<MirrorPeriod>());
  terms.add(std::make_shared<ClockDrift>());
}

}  // namespace crisp
