// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crisp/context.hpp>
#include <crisp/registrar.hpp>

#include "plugins/study/monte_carlo_trial.hpp"

namespace crisp::study {

/// Makes a new RQE for each run: a reused one may differ in its rounding.
inline MakeMeasure rqe_maker(const RunSettings& run) {
  return [registrar = run.registrar] {
    return registrar->get<MeasureRegistry>().make("rqe", {}, registrar->get<SearchRegistry>());
  };
}

}  // namespace crisp::study
