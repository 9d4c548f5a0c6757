// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/model/terms_in.hpp"

namespace crisp::model {

std::vector<std::string> terms_in(const Calibration& calibration, const TermRegistry& terms,
                                  const std::function<bool(const TermInfo&)>& is_such) {
  std::vector<std::string> names;
  const auto add = [&](const std::vector<TermParameters>& own, const std::string& before) {
    for (const TermParameters& term : own) {
      if (!is_such || is_such(terms.get(term.term)->info())) names.push_back(before + term.term);
    }
  };
  add(calibration.plate_terms, "");
  for (const auto& laser : calibration.lasers) add(laser.terms, laser.name + ".");
  return names;
}

}  // namespace crisp::model
