// SPDX-License-Identifier: BSD-3-Clause
// Corrections of a laser's ranges over time, t being the hub's time since the run's epoch.
#include <cmath>

#include "pipeline/model/terms/register_terms.hpp"

namespace crisp::model {
namespace {

struct RangeWarmup final : DifferentiableTerm<RangeWarmup> {
  const TermInfo& info() const override {
    static const TermInfo kInfo{
        .name = "range.warmup",
        .summary = "a laser's ranges drift as it warms up",
        .phase = Phase::kRange,
        .scope = Scope::kLaser,
        .parameters =
            {{.name = "c", .unit = "m", .lower = -0.5, .upper = 0.5, .summary = "in the end"},
             {.name = "T",
              .unit = "s",
              .lower = 0.5,
              .upper = 1e5,
              .neutral = 60,
              .summary = "time constant",
              .shape = true,
              .tries = {.spacing = Tries::Spacing::kLogarithmic, .from = 1, .to = 100, .count = 4}}},
        .details =
            "`r + c (1 − exp(−t/T))`, t since the run's epoch. Millimetres to centimetres over minutes to hours. In a short run it is confounded with range.offset and a linear drift.",
        .resolvable_by = "a longer recording, from a cold start",
        .counts_from = CountsFrom::kRunsEpoch,
        .level = "range.offset"};
    return kInfo;
  }
  template <class T>
  void change(Beam<T>& beam, std::span<const T> p) const {
    using std::exp;
    beam.range += p[0] * (1.0 - exp(-beam.hub_time / p[1]));
  }
};

/// A step has no derivative where it is: it is smoothed over 5 ms, less than a scan takes.
struct RangeStep final : DifferentiableTerm<RangeStep> {
  const TermInfo& info() const override {
    static const TermInfo kInfo{
        .name = "range.step",
        .summary = "all ranges of a laser step at an instant",
        .phase = Phase::kRange,
        .scope = Scope::kLaser,
        .parameters =
            {{.name = "h", .unit = "m", .lower = -0.5, .upper = 0.5, .summary = "added from then on"},
             {.name = "at",
              .unit = "s",
              .lower = -1e5,
              .upper = 1e5,
              .neutral = 0,
              .summary = "time of the step, since the run's epoch",
              .shape = true,
              .tries = {.spacing = Tries::Spacing::kInstants, .from = 0.05, .to = 0.95, .count = 19}}},
        .details =
            "`r + h (1 + tanh((t − at) / 5 ms)) / 2`: a jump. A real LMS111 reported 2.05 mm more from 2.4 s after its start on: h is −2.05 mm then.",
        .resolvable_by = "a longer recording, before it and after it",
        .counts_from = CountsFrom::kRunsEpoch};
    return kInfo;
  }
  template <class T>
  void change(Beam<T>& beam, std::span<const T> p) const {
    using std::tanh;
    constexpr double kWidth = 5e-3;  // [s]
    beam.range += p[0] * ((1.0 + tanh((beam.hub_time - p[1]) / kWidth)) / 2.0);
  }
};

}  // namespace

void register_range_in_time_terms(TermRegistry& terms) {
  terms.add(std::make_shared<RangeWarmup>());
  terms.add(std::make_shared<RangeStep>());
}

}  // namespace crisp::model
