// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include <crisp/term.hpp>

#include "example.hpp"

namespace {

/// What no built-in cause does, for the diagnosis to find: r = measured + a sin 7θ.
struct Ripple final : crisp::DifferentiableTerm<Ripple> {
  const crisp::TermInfo& info() const override {
    static const crisp::TermInfo kInfo{
        .name = "example.ripple",
        .summary = "the range ripples with the mirror's angle",
        .phase = crisp::Phase::kRange,
        .scope = crisp::Scope::kLaser,
        .parameters = {{.name = "a", .unit = "m", .lower = -0.1, .upper = 0.1, .summary = "of sin 7 theta"}}};
    return kInfo;
  }

  template <class T>
  void change(crisp::Beam<T>& beam, std::span<const T> parameters) const {
    using std::sin;
    beam.range += parameters[0] * sin(7 * beam.measured_mirror);
  }
};

}  // namespace

void register_ripple_term(crisp::Registrar& registrar) {
  registrar.get<crisp::TermRegistry>().add(std::make_shared<Ripple>());
}
