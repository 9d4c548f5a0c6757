// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crisp/effect_catalogue.hpp>

namespace crisp {

inline const TermRegistry& built_in_terms() {
  static const TermRegistry kTerms = [] {
    TermRegistry terms;
    register_built_in(terms);
    return terms;
  }();
  return kTerms;
}

}  // namespace crisp
