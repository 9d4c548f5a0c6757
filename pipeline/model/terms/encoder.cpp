// SPDX-License-Identifier: BSD-3-Clause
// By how much the plate is elsewhere than its encoder reads, φ being what it reads and ω its rate.
#include <cmath>

#include "pipeline/model/terms/register_terms.hpp"

namespace crisp::model {
namespace {

/// The encoder's disk turns about a point off its centre.
struct EncoderEccentricity final : DifferentiableTerm<EncoderEccentricity> {
  const TermInfo& info() const override {
    static const TermInfo kInfo{
        .name = "encoder.eccentricity",
        .summary = "the plate's encoder has an error with one period per turn",
        .phase = Phase::kPlate,
        .scope = Scope::kPlate,
        .parameters = {{.name = "a", .unit = "rad", .lower = -0.1, .upper = 0.1, .summary = "of cos φ"},
                       {.name = "b", .unit = "rad", .lower = -0.1, .upper = 0.1, .summary = "of sin φ"}},
        .details =
            "`φ + a cos φ + b sin φ`. A disk of 20 mm radius that is 20 µm off its axis has an error of up to 0.06°.",
        .resolvable_by = "lasers at other azimuths; other rates of the plate",
        .counts_from = CountsFrom::kEncodersZero};
    return kInfo;
  }
  template <class T>
  void change(Beam<T>& beam, std::span<const T> p) const {
    using std::cos;
    using std::sin;
    beam.plate_angle += p[0] * cos(beam.encoder_angle) + p[1] * sin(beam.encoder_angle);
  }
};

/// The disk is tilted or oval, or its signals are of unequal strength.
struct EncoderSecondHarmonic final : DifferentiableTerm<EncoderSecondHarmonic> {
  const TermInfo& info() const override {
    static const TermInfo kInfo{
        .name = "encoder.second_harmonic",
        .summary = "the plate's encoder has an error with two periods per turn",
        .phase = Phase::kPlate,
        .scope = Scope::kPlate,
        .parameters = {{.name = "a", .unit = "rad", .lower = -0.1, .upper = 0.1, .summary = "of cos 2φ"},
                       {.name = "b", .unit = "rad", .lower = -0.1, .upper = 0.1, .summary = "of sin 2φ"}},
        .details =
            "`φ + a cos 2φ + b sin 2φ`. Typically 0.02° to 0.2°. A laser's front and back, half a turn apart, have the same error: only lasers at other azimuths resolve it.",
        .resolvable_by = "lasers that are not a third of a turn apart",
        .counts_from = CountsFrom::kEncodersZero};
    return kInfo;
  }
  template <class T>
  void change(Beam<T>& beam, std::span<const T> p) const {
    using std::cos;
    using std::sin;
    const T twice = 2.0 * beam.encoder_angle;
    beam.plate_angle += p[0] * cos(twice) + p[1] * sin(twice);
  }
};

/// The plate trails or leads its encoder by the play between them, on the side of its last motion.
struct EncoderBacklash final : DifferentiableTerm<EncoderBacklash> {
  const TermInfo& info() const override {
    static const TermInfo kInfo{
        .name = "encoder.backlash",
        .summary = "backlash between the plate and its encoder",
        .phase = Phase::kPlate,
        .scope = Scope::kPlate,
        .parameters = {{.name = "delta",
                        .unit = "rad",
                        .lower = -0.1,
                        .upper = 0.1,
                        .summary = "half the backlash: lead of the plate over the encoder"}},
        .details =
            "`φ + δ s`, where `s` is the direction in which the plate has turned last: 1 counter-clockwise, −1 clockwise, kept at standstill, and changing in proportion to the angle over the first 0.01 rad (0.6°) after a reversal. Typically 0.1°. Without a reversal it is a common λ.",
        .resolvable_by = "both directions of turning, at three rates or more"};
    return kInfo;
  }
  template <class T>
  void change(Beam<T>& beam, std::span<const T> p) const {
    beam.plate_angle += p[0] * beam.plate_direction;
  }
};

/// Drag winds up what is between plate and encoder. It works against the motion and grows with the square of
/// the rate, so that it changes sign with the rate, unlike ω².
struct EncoderSpeedLag final : DifferentiableTerm<EncoderSpeedLag> {
  const TermInfo& info() const override {
    static const TermInfo kInfo{
        .name = "encoder.speed_lag",
        .summary = "the plate's angle deviates from its encoder with the square of its rate",
        .phase = Phase::kPlate,
        .scope = Scope::kPlate,
        .parameters = {{.name = "k",
                        .unit = "s^2",
                        .lower = -0.01,
                        .upper = 0.01,
                        .summary = "angle [rad] per squared rate [rad/s]"}},
        .details = "`φ + k ω |ω|`. Over a narrow range of rates it is a common η.",
        .resolvable_by = "a wide range of rates"};
    return kInfo;
  }
  template <class T>
  void change(Beam<T>& beam, std::span<const T> p) const {
    using std::abs;
    beam.plate_angle += p[0] * beam.plate_rate * abs(beam.plate_rate);
  }
};

}  // namespace

void register_encoder_terms(TermRegistry& terms) {
  terms.add(std::make_shared<EncoderEccentricity>());
  terms.add(std::make_shared<EncoderSecondHarmonic>());
  terms.add(std::make_shared<EncoderBacklash>());
  terms.add(std::make_shared<EncoderSpeedLag>());
}

}  // namespace crisp::model
