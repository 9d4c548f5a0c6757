// SPDX-License-Identifier: BSD-3-Clause
// Corrections of the range r that a laser reports.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "pipeline/model/terms/register_terms.hpp"

namespace crisp::model {
namespace {

struct RangeOffset final : DifferentiableTerm<RangeOffset> {
  const TermInfo& info() const override {
    static const TermInfo kInfo{
        .name = "range.offset",
        .summary = "a laser's ranges have a constant offset",
        .phase = Phase::kRange,
        .scope = Scope::kLaser,
        .parameters = {{.name = "c", .unit = "m", .lower = -0.5, .upper = 0.5, .summary = "added to r"}},
        .details =
            "`r + c`. The data sheet of the LMS-151 allows ±30 mm typically, ±40 mm at most. Flat walls bulge by c cos β; an offset common to all lasers hardly changes RQE.",
        .resolvable_by = "large planes and opposed walls, near and far"};
    return kInfo;
  }
  template <class T>
  void change(Beam<T>& beam, std::span<const T> p) const {
    beam.range += p[0];
  }
};

struct RangeScale final : DifferentiableTerm<RangeScale> {
  const TermInfo& info() const override {
    static const TermInfo kInfo{
        .name = "range.scale",
        .summary = "a laser's ranges have a scale error",
        .phase = Phase::kRange,
        .scope = Scope::kLaser,
        .parameters = {{.name = "s", .unit = "1", .lower = -0.05, .upper = 0.05, .summary = "share of r"}},
        .details =
            "`r (1 + s)`. Below 0.3 %. A scale common to all lasers changes the size of the whole cloud: only a known length shows it.",
        .resolvable_by = "a known length"};
    return kInfo;
  }
  template <class T>
  void change(Beam<T>& beam, std::span<const T> p) const {
    beam.range += p[0] * beam.measured_range;
  }
};

/// The spot on a tilted surface is spread in depth by r · spread · tan β, which stretches the echo; where
/// both its own length and that spread count, the echo's length grows as the root of their squares.
struct RangeIncidence final : DifferentiableTerm<RangeIncidence> {
  const TermInfo& info() const override {
    static const TermInfo kInfo{
        .name = "range.incidence",
        .summary = "a laser's range error depends on the incidence",
        .phase = Phase::kRange,
        .scope = Scope::kLaser,
        .parameters =
            {{.name = "c", .unit = "m", .lower = -1, .upper = 1, .summary = "how strong"},
             {.name = "spread",
              .unit = "1/m",
              .lower = 0.01,
              .upper = 1,
              .neutral = 0.06,
              .summary = "spread of the spot in depth at 45°, in lengths of the echo per metre of range",
              .shape = true,
              .tries = {.spacing = Tries::Spacing::kLogarithmic, .from = 0.03, .to = 0.3, .count = 3}}},
        .details =
            "`r + c (√(1 + (spread r tan β)²) − 1)`. With a c of 47 mm and a spread of 0.06/m it is 6 mm at 60°, 14 mm at 70° and 46 mm at 80°, 5 m away, which is what Laconte et al. (Lidar measurement bias estimation via return waveform modelling, ICRA 2019) measured, an LMS-151 among the sensors. β comes from the surfaces, so the term has no effect before they are segmented; β is clipped at 87°.",
        .resolvable_by = "the same range at many incidences; patches of different reflectance",
        .needs_incidence = true};
    return kInfo;
  }
  template <class T>
  void change(Beam<T>& beam, std::span<const T> p) const {
    using std::sqrt;
    constexpr double kGrazing = 0.05;  // cosine of the steepest incidence that is resolved
    const double cosine = std::clamp(std::abs(beam.cos_incidence), kGrazing, 1.0);
    const double tangent = std::sqrt(1 - cosine * cosine) / cosine;
    const T spread = p[1] * (beam.measured_range * tangent);
    beam.range += p[0] * (sqrt(1.0 + spread * spread) - 1.0);
  }
};

/// A weak echo crosses the threshold late. Amplitudes spread over decades, so their logarithm counts, whose
/// zero is at a remission of 100.
struct RangeIntensity final : DifferentiableTerm<RangeIntensity> {
  const TermInfo& info() const override {
    static const TermInfo kInfo{
        .name = "range.intensity",
        .summary = "a laser's ranges depend on the strength of the echo (range walk)",
        .phase = Phase::kRange,
        .scope = Scope::kLaser,
        .parameters = {{.name = "a", .unit = "m", .lower = -0.2, .upper = 0.2, .summary = "of u"},
                       {.name = "b", .unit = "m", .lower = -0.2, .upper = 0.2, .summary = "of u²"}},
        .details =
            "`r + a u + b u²` with `u = ln(I / 100)`, I the remission in the device's units; nothing where it is unknown (0). Millimetres to centimetres. As the remission falls with the incidence, it is confounded with range.incidence; neighbouring dark and light patches distinguish them.",
        .resolvable_by = "dark and light patches side by side",
        .level = "range.offset"};
    return kInfo;
  }
  template <class T>
  void change(Beam<T>& beam, std::span<const T> p) const {
    if (!(beam.remission > 0)) return;
    constexpr double kMiddle = 100;
    const double u = std::log(beam.remission / kMiddle);
    beam.range += p[0] * u + p[1] * (u * u);
  }
};

struct RangeCyclic final : DifferentiableTerm<RangeCyclic> {
  const TermInfo& info() const override {
    static const TermInfo kInfo{
        .name = "range.cyclic",
        .summary = "a laser's range error is periodic in range",
        .phase = Phase::kRange,
        .scope = Scope::kLaser,
        .parameters =
            {{.name = "a", .unit = "m", .lower = -0.1, .upper = 0.1, .summary = "of sin 2πr/P"},
             {.name = "b", .unit = "m", .lower = -0.1, .upper = 0.1, .summary = "of cos 2πr/P"},
             {.name = "P",
              .unit = "m",
              .lower = 0.05,
              .upper = 50,
              .neutral = 1,
              .summary = "period",
              .shape = true,
              .tries = {.spacing = Tries::Spacing::kRangePeriods, .from = 0.5, .to = 16, .count = 32}}},
        .details =
            "`r + a sin 2πr/P + b cos 2πr/P`, which is `A sin(2πr/P + p)` with `A² = a² + b²` and `tan p = b/a`, but linear in the parameters. Typically millimetres: crosstalk and the steps of a time-to-digital converter. P must exceed 2πA, so that a distance has one range.",
        .resolvable_by = "surfaces at many distances"};
    return kInfo;
  }
  template <class T>
  void change(Beam<T>& beam, std::span<const T> p) const {
    using std::cos;
    using std::sin;
    const T turned = (2 * std::numbers::pi * beam.measured_range) / p[2];
    beam.range += p[0] * sin(turned) + p[1] * cos(turned);
  }
};

}  // namespace

void register_range_terms(TermRegistry& terms) {
  terms.add(std::make_shared<RangeOffset>());
  terms.add(std::make_shared<RangeScale>());
  terms.add(std::make_shared<RangeIncidence>());
  terms.add(std::make_shared<RangeIntensity>());
  terms.add(std::make_shared<RangeCyclic>());
}

}  // namespace crisp::model
