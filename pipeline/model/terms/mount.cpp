// SPDX-License-Identifier: BSD-3-Clause
// How a laser sits on the plate, beyond λ, τ and α. In the plate's frame at the laser: x outwards, y along
// the tangent (the way of increasing φ), z the spin axis.
#include <cmath>

#include "pipeline/model/terms/register_terms.hpp"

namespace crisp::model {
namespace {

/// The beam starts y further along the tangent.
struct TangentialOffset final : DifferentiableTerm<TangentialOffset> {
  const TermInfo& info() const override {
    static const TermInfo kInfo{
        .name = "mount.tangential_offset",
        .summary = "the beams of a laser start off its radius",
        .phase = Phase::kMount,
        .scope = Scope::kLaser,
        .parameters =
            {{.name = "y", .unit = "m", .lower = -0.5, .upper = 0.5, .summary = "along the tangent"}},
        .details =
            "`origin += (0, y, 0)` in the plate's frame at the laser. Typically 1 to 5 mm. With other λ, τ and α the laser is in the same place, so that no recording shows it.",
        .resolvable_by = "no recording, since it is another lambda, tau and alpha"};
    return kInfo;
  }
  template <class T>
  void change(Beam<T>& beam, std::span<const T> p) const {
    beam.origin.y() += p[0];
  }
};

/// The beam starts z higher.
struct AxialOffset final : DifferentiableTerm<AxialOffset> {
  const TermInfo& info() const override {
    static const TermInfo kInfo{
        .name = "mount.axial_offset",
        .summary = "a laser sits higher on the plate than the others",
        .phase = Phase::kMount,
        .scope = Scope::kLaser,
        .parameters = {{.name = "z", .unit = "m", .lower = -0.5, .upper = 0.5, .summary = "along the axis"}},
        .details =
            "`origin += (0, 0, z)` in the plate's frame. Typically 1 to 20 mm. A height common to all lasers moves the whole cloud and is not identifiable: the height of one laser is held at 0.",
        .resolvable_by = "another laser in the same recording: a common height is a gauge"};
    return kInfo;
  }
  template <class T>
  void change(Beam<T>& beam, std::span<const T> p) const {
    beam.origin.z() += p[0];
  }
};

/// The mirror's angle has another zero than the rig's `mount`.
struct MirrorZero final : DifferentiableTerm<MirrorZero> {
  const TermInfo& info() const override {
    static const TermInfo kInfo{
        .name = "mount.mirror_zero",
        .summary = "a laser is rotated within its scan plane against its mount angle",
        .phase = Phase::kMirror,
        .scope = Scope::kLaser,
        .parameters =
            {{.name = "theta", .unit = "rad", .lower = -0.2, .upper = 0.2, .summary = "added to θ"}},
        .details = "`θ + theta`. Typically 0.1° to 1°. It has opposite signs at a laser's front and back.",
        .resolvable_by = "the same surfaces to the front and to the back of the laser"};
    return kInfo;
  }
  template <class T>
  void change(Beam<T>& beam, std::span<const T> p) const {
    beam.mirror_angle += p[0];
  }
};

/// The scan plane is turned about its horizontal line, which is the tangent where α = 0. About the tangent, a
/// radial scan plane would turn within itself, as by its mirror's zero.
struct ScanPlaneTilt final : DifferentiableTerm<ScanPlaneTilt> {
  const TermInfo& info() const override {
    static const TermInfo kInfo{
        .name = "mount.scan_plane_tilt",
        .summary = "a laser's scan plane is tilted against the spin axis",
        .phase = Phase::kBeam,
        .scope = Scope::kLaser,
        .parameters =
            {{.name = "tilt",
              .unit = "rad",
              .lower = -0.2,
              .upper = 0.2,
              .summary =
                  "right-handed about the scan plane's horizontal line (the tangent where α = 0): the beam at θ = 0 tilts towards the axis"}},
        .details =
            "`direction = Ry(tilt) direction` in the laser's frame, before α turns it. Typically 0.1° to 1°. In a narrow field of view it resembles α.",
        .resolvable_by = "the whole sweep of the mirror"};
    return kInfo;
  }
  template <class T>
  void change(Beam<T>& beam, std::span<const T> p) const {
    using std::cos;
    using std::sin;
    const T c = cos(p[0]);
    const T s = sin(p[0]);
    const Vector3<T> d = beam.direction;
    beam.direction = {c * d.x() + s * d.z(), d.y(), c * d.z() - s * d.x()};
  }
};

}  // namespace

void register_mount_terms(TermRegistry& terms) {
  terms.add(std::make_shared<TangentialOffset>());
  terms.add(std::make_shared<AxialOffset>());
  terms.add(std::make_shared<MirrorZero>());
  terms.add(std::make_shared<ScanPlaneTilt>());
}

}  // namespace crisp::model
