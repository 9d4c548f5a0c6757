// SPDX-License-Identifier: BSD-3-Clause
#include <crisp/plugin.hpp>

#include "example.hpp"

namespace {

void register_all(crisp::Registrar& registrar) {
  register_near_stage(registrar);
  register_reach_stage(registrar);
  register_drift_term(registrar);
  register_ripple_term(registrar);
  register_spread_measure(registrar);
}

}  // namespace

CRISP_PLUGIN("example", "1.0", register_all);
