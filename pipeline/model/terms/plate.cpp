// SPDX-License-Identifier: BSD-3-Clause
// How the plate's axis moves while it turns, in the base's frame: z is the mean spin axis, its origin the
// scanner's centre. What turns with the plate is part of how the lasers sit on it; so both are given along x
// and y of the base, which do not turn, and may be of different size there.
#include <cmath>

#include "pipeline/model/rotation.hpp"
#include "pipeline/model/terms/register_terms.hpp"

namespace crisp::model {
namespace {

/// The harmonic u cos φ + v sin φ.
template <class T>
T once_a_turn(const Beam<T>& beam, const T& u, const T& v) {
  using std::cos;
  using std::sin;
  return u * cos(beam.plate_angle) + v * sin(beam.plate_angle);
}

/// The fundamental tilt error motion of the spindle (ISO 230-7), in fixed directions.
struct Wobble final : DifferentiableTerm<Wobble> {
  const TermInfo& info() const override {
    static const TermInfo kInfo{
        .name = "plate.wobble",
        .summary = "wobble: the spin axis tilts with one period per turn",
        .phase = Phase::kBase,
        .scope = Scope::kPlate,
        .parameters =
            {{.name = "a", .unit = "rad", .lower = -0.05, .upper = 0.05, .summary = "about x, of cos φ"},
             {.name = "b", .unit = "rad", .lower = -0.05, .upper = 0.05, .summary = "about x, of sin φ"},
             {.name = "c", .unit = "rad", .lower = -0.05, .upper = 0.05, .summary = "about y, of cos φ"},
             {.name = "d", .unit = "rad", .lower = -0.05, .upper = 0.05, .summary = "about y, of sin φ"}},
        .details =
            "`x = Rx(a cos φ + b sin φ) Ry(c cos φ + d sin φ) x` in the base's frame, about the scanner's centre. Typically 0.006° to 0.2°. The part with a = d, b = −c turns with the plate: it is a tilt of the plate on its axis, which all lasers share.",
        .resolvable_by = "floor and ceiling as well as walls on all sides",
        .counts_from = CountsFrom::kEncodersZero};
    return kInfo;
  }
  template <class T>
  void change(Beam<T>& beam, std::span<const T> p) const {
    rotate(beam, Rotation<T>(once_a_turn(beam, p[0], p[1]), once_a_turn(beam, p[2], p[3]), T(0)));
  }
};

/// An unbalanced plate pulls the scanner around with a force ω²; what carries it yields differently along x
/// and y.
struct Rocking final : DifferentiableTerm<Rocking> {
  const TermInfo& info() const override {
    static const TermInfo kInfo{
        .name = "plate.rocking",
        .summary = "imbalance shifts the scanner once per turn, with the square of the rate",
        .phase = Phase::kBase,
        .scope = Scope::kPlate,
        .parameters =
            {{.name = "a", .unit = "m s^2", .lower = -1e-3, .upper = 1e-3, .summary = "along x, of cos φ"},
             {.name = "b", .unit = "m s^2", .lower = -1e-3, .upper = 1e-3, .summary = "along x, of sin φ"},
             {.name = "c", .unit = "m s^2", .lower = -1e-3, .upper = 1e-3, .summary = "along y, of cos φ"},
             {.name = "d", .unit = "m s^2", .lower = -1e-3, .upper = 1e-3, .summary = "along y, of sin φ"}},
        .details =
            "`origin += ω² (a cos φ + b sin φ, c cos φ + d sin φ, 0)` in the base's frame, ω in rad/s: 1e-5 m s² are 1.6 mm at 2 Hz. Typically mm. At one speed the part with a = d, b = −c is a common shift of the lasers on the plate.",
        .resolvable_by = "two rates of the plate",
        .counts_from = CountsFrom::kEncodersZero};
    return kInfo;
  }
  template <class T>
  void change(Beam<T>& beam, std::span<const T> p) const {
    const T force = beam.plate_rate * beam.plate_rate;
    beam.origin.x() += force * once_a_turn(beam, p[0], p[1]);
    beam.origin.y() += force * once_a_turn(beam, p[2], p[3]);
  }
};

}  // namespace

void register_plate_terms(TermRegistry& terms) {
  terms.add(std::make_shared<Wobble>());
  terms.add(std::make_shared<Rocking>());
}

}  // namespace crisp::model
