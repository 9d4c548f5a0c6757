// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/report/calibration_json.hpp"

#include <cmath>
#include <map>

#include "pipeline/data/each_parameter.hpp"
#include "pipeline/data/shown_unit.hpp"

namespace crisp::report {
namespace {

using Json = nlohmann::ordered_json;

std::map<std::string, Parameter> by_name(const Calibration& calibration) {
  std::map<std::string, Parameter> all;
  data::for_each_parameter(calibration, [&](const std::string& name, const Parameter& p) { all[name] = p; });
  return all;
}

Json parameters_json(const Calibration& calibration, const Calibration& nominal, const Calibration* against) {
  const auto nominals = by_name(nominal);
  const auto earlier = against ? by_name(*against) : std::map<std::string, Parameter>();
  Json all = Json::array();
  data::for_each_parameter(calibration, [&](const std::string& name, const Parameter& p) {
    const data::ShownUnit unit = data::shown_unit(p.unit);
    Json row = {{"name", name}, {"unit", unit.name}, {"value", unit.factor * p.value}, {"free", p.free}};
    if (p.free) row["std_error"] = unit.factor * p.std_error;
    if (const auto found = nominals.find(name); found != nominals.end())
      row["nominal"] = unit.factor * found->second.value;
    if (const auto found = earlier.find(name); found != earlier.end()) {
      row["against"] = unit.factor * found->second.value;
      row["against_std_error"] = unit.factor * found->second.std_error;
    }
    all.push_back(std::move(row));
  });
  return all;
}

/// Row by row; 0 where a variance is.
Json correlations_json(const Calibration& calibration) {
  constexpr double kDigits = 1000;
  const std::size_t m = calibration.covariance_order.size();
  if (calibration.covariance.size() != m * m) return Json::array();
  const auto covariance = [&](std::size_t i, std::size_t j) { return calibration.covariance[i * m + j]; };
  Json rows = Json::array();
  for (std::size_t i = 0; i < m; ++i) {
    Json row = Json::array();
    for (std::size_t j = 0; j < m; ++j) {
      const double scale = std::sqrt(covariance(i, i) * covariance(j, j));
      row.push_back(scale > 0 ? std::round(kDigits * covariance(i, j) / scale) / kDigits : 0.0);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

Json unobservable_json_of(const Calibration& calibration) {
  Json all = Json::array();
  for (const Unobservable& one : calibration.unobservable) {
    all.push_back({{"parameter", one.parameter}, {"reason", one.reason}, {"combination", one.combination}});
  }
  return all;
}

}  // namespace

Json calibration_json(const Calibration& calibration, const Calibration& nominal,
                      const Calibration* against) {
  Json lasers = Json::array();
  for (const auto& laser : calibration.lasers) lasers.push_back(laser.name);
  return {{"lasers", lasers},
          {"parameters", parameters_json(calibration, nominal, against)},
          {"order", calibration.covariance_order},
          {"correlations", correlations_json(calibration)},
          {"quality", calibration.quality},
          {"unobservable", unobservable_json_of(calibration)},
          {"caveats", calibration.caveats},
          {"provenance", calibration.provenance}};
}

}  // namespace crisp::report
