// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pipeline/stage/context.hpp"
#include "pipeline/stage/registry.hpp"
#include "plugins/study/trial.hpp"

namespace crisp {

/// Makes a fresh RQE for each run: one that is used again may differ in its rounding.
inline MakeMeasure rqe_maker(const RunSettings& run) {
  return [registrar = run.registrar] {
    return registrar->get<MeasureRegistry>().make("rqe", {}, registrar->get<SearchRegistry>());
  };
}

}  // namespace crisp
