// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crisp/registrar.hpp>

void register_near_stage(crisp::Registrar& registrar);
void register_reach_stage(crisp::Registrar& registrar);
void register_drift_term(crisp::Registrar& registrar);
void register_ripple_term(crisp::Registrar& registrar);
void register_spread_measure(crisp::Registrar& registrar);
