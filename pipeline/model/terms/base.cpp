// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <numbers>

#include "pipeline/model/rotation.hpp"
#include "pipeline/model/terms/register_terms.hpp"

namespace crisp::model {
namespace {

/// A mast that sways in the wind, a tripod that sinks: the whole scanner moves in time, whatever the plate
/// does.
struct BaseMotion final : DifferentiableTerm<BaseMotion> {
  const TermInfo& info() const override {
    static const TermInfo kInfo{
        .name = "base.motion",
        .summary = "the whole scanner drifts or sways",
        .phase = Phase::kBase,
        .scope = Scope::kPlate,
        .parameters =
            {{.name = "vx",
              .unit = "m/s",
              .lower = -1,
              .upper = 1,
              .summary = "drift along x",
              .is_the_same_in_every_form = true},
             {.name = "vy",
              .unit = "m/s",
              .lower = -1,
              .upper = 1,
              .summary = "drift along y",
              .is_the_same_in_every_form = true},
             {.name = "vz",
              .unit = "m/s",
              .lower = -1,
              .upper = 1,
              .summary = "drift along z",
              .is_the_same_in_every_form = true},
             {.name = "ax", .unit = "m", .lower = -0.5, .upper = 0.5, .summary = "along x, of cos 2πft"},
             {.name = "bx", .unit = "m", .lower = -0.5, .upper = 0.5, .summary = "along x, of sin 2πft"},
             {.name = "ay", .unit = "m", .lower = -0.5, .upper = 0.5, .summary = "along y, of cos 2πft"},
             {.name = "by", .unit = "m", .lower = -0.5, .upper = 0.5, .summary = "along y, of sin 2πft"},
             {.name = "f",
              .unit = "Hz",
              .lower = 0.1,
              .upper = 20,
              .neutral = 1,
              .summary = "frequency of the sway",
              .shape = true,
              .tries = {.spacing = Tries::Spacing::kLinear, .from = 0.1, .to = 2, .count = 20}}},
        .details =
            "`origin += (vx t + ax cos 2πft + bx sin 2πft, vy t + ay cos 2πft + by sin 2πft, vz t)` in the base's frame, t on the plate's clock since the run's epoch. A sway at the plate's own rate resembles wobble or rocking: another speed distinguishes them.",
        .resolvable_by = "a varying rate of the plate",
        .counts_from = CountsFrom::kRunsEpoch};
    return kInfo;
  }
  template <class T>
  void change(Beam<T>& beam, std::span<const T> p) const {
    using std::cos;
    using std::sin;
    const T& t = beam.time;
    const T turned = 2 * std::numbers::pi * p[7] * t;
    const T c = cos(turned);
    const T s = sin(turned);
    beam.origin += Vector3<T>(p[0] * t + p[3] * c + p[4] * s, p[1] * t + p[5] * c + p[6] * s, p[2] * t);
  }
};

/// What carries the scanner tilts: it sinks on one side, or rocks.
struct BaseTilt final : DifferentiableTerm<BaseTilt> {
  const TermInfo& info() const override {
    static const TermInfo kInfo{
        .name = "base.tilt",
        .summary = "the whole scanner tilts or rocks",
        .phase = Phase::kBase,
        .scope = Scope::kPlate,
        .parameters =
            {{.name = "wx",
              .unit = "rad/s",
              .lower = -0.1,
              .upper = 0.1,
              .summary = "drift about x",
              .is_the_same_in_every_form = true},
             {.name = "wy",
              .unit = "rad/s",
              .lower = -0.1,
              .upper = 0.1,
              .summary = "drift about y",
              .is_the_same_in_every_form = true},
             {.name = "wz",
              .unit = "rad/s",
              .lower = -0.1,
              .upper = 0.1,
              .summary = "drift about z",
              .is_the_same_in_every_form = true},
             {.name = "ax", .unit = "rad", .lower = -0.1, .upper = 0.1, .summary = "about x, of cos 2πft"},
             {.name = "bx", .unit = "rad", .lower = -0.1, .upper = 0.1, .summary = "about x, of sin 2πft"},
             {.name = "ay", .unit = "rad", .lower = -0.1, .upper = 0.1, .summary = "about y, of cos 2πft"},
             {.name = "by", .unit = "rad", .lower = -0.1, .upper = 0.1, .summary = "about y, of sin 2πft"},
             {.name = "f",
              .unit = "Hz",
              .lower = 0.1,
              .upper = 20,
              .neutral = 1,
              .summary = "frequency of the rocking",
              .shape = true,
              .tries = {.spacing = Tries::Spacing::kLinear, .from = 0.1, .to = 2, .count = 20}}},
        .details =
            "`x = Rx(wx t + ax cos 2πft + bx sin 2πft) Ry(wy t + ay cos 2πft + by sin 2πft) Rz(wz t) x` in the base's frame, t on the plate's clock since the run's epoch: a tripod that sinks on one side, a mast that rocks. Reported as base.motion. At the plate's own rate it resembles wobble: another speed distinguishes them.",
        .resolvable_by = "a varying rate of the plate",
        .counts_from = CountsFrom::kRunsEpoch,
        .family = "base.motion"};
    return kInfo;
  }
  template <class T>
  void change(Beam<T>& beam, std::span<const T> p) const {
    using std::cos;
    using std::sin;
    const T& t = beam.time;
    const T turned = 2 * std::numbers::pi * p[7] * t;
    const T c = cos(turned);
    const T s = sin(turned);
    rotate(beam, Rotation<T>(p[0] * t + p[3] * c + p[4] * s, p[1] * t + p[5] * c + p[6] * s, p[2] * t));
  }
};

}  // namespace

void register_base_terms(TermRegistry& terms) {
  terms.add(std::make_shared<BaseMotion>());
  terms.add(std::make_shared<BaseTilt>());
}

}  // namespace crisp::model
