// SPDX-License-Identifier: BSD-3-Clause
// Corrections of a beam's firing time, beyond η: added to its hub time before the plate's angle is
// interpolated.
#include <numbers>

#include "pipeline/model/terms/register_terms.hpp"

namespace crisp::model {
namespace {

/// The time between beams is not what was taken for it, or was left out altogether.
struct IntraScan final : DifferentiableTerm<IntraScan> {
  const TermInfo& info() const override {
    static const TermInfo kInfo{
        .name = "timing.intra_scan",
        .summary = "the time between a scan's beams differs from the assumed one",
        .phase = Phase::kTime,
        .scope = Scope::kLaser,
        .parameters = {{.name = "kappa",
                        .unit = "s",
                        .lower = -1e-3,
                        .upper = 1e-3,
                        .summary = "excess of the time between two beams over the assumed one"}},
        .details =
            "`t + κ k` for beam k of its scan, so that φ changes by `ω κ k`. Where the time between beams is neglected, κ is 28 µs at 50 Hz and half a degree, which is 2.7° over a sweep while the plate turns at 0.5 Hz. At one speed it resembles α.",
        .resolvable_by = "a reversal of the plate, or other rates; the mirror's own stamps"};
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
        .summary = "a laser's mirror period differs from the assumed one",
        .phase = Phase::kTime,
        .scope = Scope::kLaser,
        .parameters = {{.name = "excess",
                        .unit = "s",
                        .lower = -1e-2,
                        .upper = 1e-2,
                        .summary = "excess of the mirror's period over the assumed one"}},
        .details =
            "`t + excess θ/2π`: a term for measurements whose times assume a nominal period. Real LMS1xx are 0.57 % slow, 114 µs of 20 ms, and wander by ±0.2 % within seconds. Within one scan it is confounded with timing.intra_scan: the stamps of successive scans distinguish them. Simulated telegrams come from a mirror with this period.",
        .resolvable_by = "the mirror's own stamps"};
    return kInfo;
  }
  template <class T>
  void change(Beam<T>& beam, std::span<const T> p) const {
    beam.time += p[0] * (beam.measured_mirror / (2 * std::numbers::pi));
  }
};

/// Residual drift of a device's clock whose rate was assumed constant.
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
                        .summary = "hub seconds per device second − 1, beyond the assumed rate"},
                       {.name = "drift",
                        .unit = "1/s",
                        .lower = -1e-3,
                        .upper = 1e-3,
                        .summary = "growth of the skew per second"}},
        .details =
            "`t + skew t + drift t²/2`, t since the run's epoch: a lag that varies with time. 20 ppm over 0 to 50 °C; Sheehan, Harrison and Newman lost 90 s in 5 days, 208 ppm. Simulated telegrams carry the stamps of a clock with this drift.",
        .resolvable_by = "a longer recording",
        .counts_from = CountsFrom::kRunsEpoch};
    return kInfo;
  }
  template <class T>
  void change(Beam<T>& beam, std::span<const T> p) const {
    beam.time += beam.hub_time * (p[0] + p[1] * (beam.hub_time / 2));
  }
};

/// Error of a clock's line, which telegrams' delays determine with a standard error.
struct ClockSkew final : DifferentiableTerm<ClockSkew> {
  const TermInfo& info() const override {
    static const TermInfo kInfo{
        .name = "clock.skew",
        .summary = "the constant rate of a device's clock is off",
        .phase = Phase::kTime,
        .scope = Scope::kLaser,
        .parameters = {{.name = "skew",
                        .unit = "1",
                        .lower = -0.01,
                        .upper = 0.01,
                        .summary = "hub seconds per device second − 1, beyond the assumed rate"},
                       {.name = "middle",
                        .unit = "s",
                        .lower = -1e5,
                        .upper = 1e5,
                        .summary = "time since the run's epoch at which the clock is right",
                        .shape = true}},
        .details =
            "`t + skew (t − middle)`, t since the run's epoch. The shortest delays of telegrams determine a clock's rate with a standard error of some ppm within seconds. With that as its prior, the diagnosis estimates the skew together with λ, τ, α and η (a nuisance parameter). It is no cause; a changing rate is clock.drift, which telegrams are simulated with.",
        .resolvable_by = "a longer recording",
        .counts_from = CountsFrom::kRunsEpoch,
        .is_nuisance = true};
    return kInfo;
  }
  template <class T>
  void change(Beam<T>& beam, std::span<const T> p) const {
    beam.time += p[0] * (beam.hub_time - p[1]);
  }
};

}  // namespace

void register_timing_terms(TermRegistry& terms) {
  terms.add(std::make_shared<IntraScan>());
  terms.add(std::make_shared<MirrorPeriod>());
  terms.add(std::make_shared<ClockDrift>());
  terms.add(std::make_shared<ClockSkew>());
}

}  // namespace crisp::model
