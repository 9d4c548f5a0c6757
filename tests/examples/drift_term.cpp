// SPDX-License-Identifier: BSD-3-Clause
#include <crisp/term.hpp>

#include "example.hpp"

namespace {

/// A range that drifts as a unit warms up: r = measured + rate · t. The formula is written once; derivatives
/// for the calibration come by themselves.
struct Drift final : crisp::DifferentiableTerm<Drift> {
  const crisp::TermInfo& info() const override {
    static const crisp::TermInfo kInfo{
        .name = "example.drift",
        .summary = "the range drifts with time",
        .phase = crisp::Phase::kRange,
        .scope = crisp::Scope::kLaser,
        .parameters = {
            {.name = "rate", .unit = "m/s", .lower = -1, .upper = 1, .summary = "growth of the range"}}};
    return kInfo;
  }

  template <class T>
  void change(crisp::Beam<T>& beam, std::span<const T> parameters) const {
    beam.range += parameters[0] * beam.hub_time;
  }
};

}  // namespace

void register_drift_term(crisp::Registrar& registrar) {
  registrar.get<crisp::TermRegistry>().add(std::make_shared<Drift>());
}
