// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include "pipeline/files/calibration_file.hpp"
#include "plugins/write/calibration_stage.hpp"

namespace crisp {
namespace {

/// Calls `visit` with the owner's name and each parameter, in the order of the file.
template <class Visit>
void for_each_parameter(const Calibration& calibration, Visit visit) {
  const auto visit_terms = [&](const std::string& owner, const std::vector<TermParameters>& terms) {
    for (const auto& term : terms) {
      for (const auto& p : term.parameters) visit(owner + "." + term.term + "." + p.name, p);
    }
  };
  for (const auto& laser : calibration.lasers) {
    for (const Parameter* p : {&laser.lambda, &laser.tau, &laser.alpha, &laser.eta}) {
      visit(laser.name + "." + p->name, *p);
    }
    visit_terms(laser.name, laser.terms);
  }
  visit_terms("plate", calibration.plate_terms);
}

Inspection inspect(const std::filesystem::path& file, const Rig&) {
  const Calibration calibration = read_calibration(file);
  Inspection inspection;
  inspection.text = fmt::format("  {:<36}{:>14} {:<5}{:>12}", "parameter", "value", "unit", "std error");
  for_each_parameter(calibration, [&](const std::string& name, const Parameter& p) {
    const std::string error = p.free ? fmt::format("{:12.2g}", p.std_error) : fmt::format("{:>12}", "fixed");
    inspection.text += fmt::format("\n  {:<36}{:>14.8g} {:<5}{}", name, p.value, p.unit, error);
    inspection.data["parameters"][name] = {
        {"value", p.value}, {"unit", p.unit}, {"std_error", p.std_error}, {"free", p.free}};
  });
  for (const auto& [name, value] : calibration.quality) {
    inspection.text += fmt::format("\n  {:<36}{:>14.8g}", name, value);
  }
  for (const auto& u : calibration.unobservable) {
    inspection.text += fmt::format("\n  unobservable: {}: {}", u.parameter, u.reason);
    inspection.data["unobservable"].push_back(u.parameter);
  }
  inspection.data["quality"] = calibration.quality;
  inspection.data["provenance"] = calibration.provenance;
  for (const auto& [key, value] : calibration.provenance)
    inspection.text += fmt::format("\n  {}: {}", key, value);
  return inspection;
}

/// Both a rig and a calibration begin with the schema and the lasers; only a calibration gives values of
/// them.
bool recognises(std::string_view head) {
  return head.find("crisp:") != std::string_view::npos && head.find("lasers:") != std::string_view::npos &&
         head.find("value:") != std::string_view::npos;
}

}  // namespace

Inspector calibration_inspector() { return {"a calibration", recognises, inspect}; }

}  // namespace crisp
