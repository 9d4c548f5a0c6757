// SPDX-License-Identifier: BSD-3-Clause
// What a laser's mirror does to a beam. In the laser's frame: the scan plane is z = 0, θ = 0 along x.
#include <cmath>

#include "pipeline/model/terms/register_terms.hpp"

namespace crisp::model {
namespace {

/// A mirror that is not at 45° to its axis sends the beam out of the plane that it should sweep.
struct Cone final : DifferentiableTerm<Cone> {
  const TermInfo& info() const override {
    static const TermInfo kInfo{
        .name = "mirror.cone",
        .summary = "a laser's beam sweeps a cone instead of a plane",
        .phase = Phase::kBeam,
        .scope = Scope::kLaser,
        .parameters = {{.name = "kappa",
                        .unit = "rad",
                        .lower = -0.1,
                        .upper = 0.1,
                        .summary = "angle of the beam above the scan plane, outwards on the plate"}},
        .details =
            "`direction = cos κ (cos θ, sin θ, 0) + sin κ (0, 0, 1)` in the laser's frame. Typically 0.05° to 0.4°. At one range it resembles a tangential offset.",
        .resolvable_by = "surfaces near and far"};
    return kInfo;
  }
  template <class T>
  void change(Beam<T>& beam, std::span<const T> p) const {
    using std::cos;
    using std::sin;
    beam.direction *= cos(p[0]);
    beam.direction.z() += sin(p[0]);
  }
};

/// The disk that reads the mirror's angle is centred off the mirror's axis.
struct MirrorEccentricity final : DifferentiableTerm<MirrorEccentricity> {
  const TermInfo& info() const override {
    static const TermInfo kInfo{
        .name = "mirror.eccentricity",
        .summary = "a laser's mirror angle has an error with one period per turn",
        .phase = Phase::kMirror,
        .scope = Scope::kLaser,
        .parameters = {{.name = "a", .unit = "rad", .lower = -0.05, .upper = 0.05, .summary = "of cos θ"},
                       {.name = "b", .unit = "rad", .lower = -0.05, .upper = 0.05, .summary = "of sin θ"}},
        .details =
            "`θ + a cos θ + b sin θ`, θ as reported less the mount angle. Typically 0.05° to 0.2°. A beam that starts off the mirror's axis is indistinguishable at one range.",
        .resolvable_by = "surfaces near and far"};
    return kInfo;
  }
  template <class T>
  void change(Beam<T>& beam, std::span<const T> p) const {
    beam.mirror_angle += p[0] * std::cos(beam.measured_mirror) + p[1] * std::sin(beam.measured_mirror);
  }
};

}  // namespace

void register_mirror_terms(TermRegistry& terms) {
  terms.add(std::make_shared<Cone>());
  terms.add(std::make_shared<MirrorEccentricity>());
}

}  // namespace crisp::model
