// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/outcome.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pipeline/data/each_parameter.hpp"
#include "pipeline/data/shown_unit.hpp"

namespace crisp::estimate {
namespace {

/// Why a parameter has no standard error.
///
/// @param change  of the value from nominal [SI]
std::string remark(const Parameter& parameter, const std::string& name, const Calibration& calibration,
                   double change) {
  constexpr double kSmall = 1e-9;
  const auto& list = calibration.unobservable;
  const bool unknown =
      std::any_of(list.begin(), list.end(), [&](const auto& u) { return u.parameter == name; });
  if (!unknown && parameter.free) return "";
  if (!unknown) return "kept";
  // Moved by itself, it would move the cloud: only its combination with others is determined.
  return std::abs(change) > kSmall ? "not observable by itself" : "not observable";
}

/// Number of decimals that show two digits of the error; four without an error, or for a large one.
int decimals_for(double error) {
  constexpr int kMin = 4;
  constexpr int kMax = 12;
  if (!(error > 0)) return kMin;
  return std::clamp(data::decimals_that_show(error), kMin, kMax);
}

}  // namespace

Calibration calibration_of(const Outcome& outcome, const Rig& rig) {
  Calibration calibration = outcome.model.calibration();
  const auto m = static_cast<Eigen::Index>(outcome.free.size());
  calibration.covariance_order.clear();
  for (const std::size_t slot : outcome.free) {
    calibration.covariance_order.push_back(outcome.model.names()[slot]);
  }
  calibration.covariance.clear();
  for (Eigen::Index i = 0; i < m; ++i) {
    for (Eigen::Index j = 0; j < m; ++j) calibration.covariance.push_back(outcome.covariance(i, j));
  }
  const auto& order = calibration.covariance_order;
  data::for_each_parameter(calibration, [&](const std::string& name, Parameter& parameter) {
    const auto found = std::find(order.begin(), order.end(), name);
    parameter.free = found != order.end();
    const auto at = found - order.begin();
    parameter.std_error = parameter.free ? std::sqrt(outcome.covariance(at, at)) : 0;
  });
  calibration.unobservable = outcome.unobservable;
  return with_angles_near(std::move(calibration), rig);
}

Calibration with_angles_near(Calibration calibration, const Rig& rig) {
  constexpr double kTurn = 2 * std::numbers::pi;
  const auto bring_near = [](Parameter& angle, const Parameter& nominal) {
    angle.value = nominal.value + std::remainder(angle.value - nominal.value, kTurn);
  };
  for (std::size_t i = 0; i < std::min(calibration.lasers.size(), rig.lasers.size()); ++i) {
    bring_near(calibration.lasers[i].lambda, rig.lasers[i].nominal.lambda);
    bring_near(calibration.lasers[i].alpha, rig.lasers[i].nominal.alpha);
  }
  return calibration;
}

std::string table_of(const Calibration& calibration, const Rig& rig) {
  std::map<std::string, double> nominal;
  const Calibration start = nominal_calibration(rig);
  data::for_each_parameter(start,
                           [&](const std::string& name, const Parameter& p) { nominal[name] = p.value; });
  std::string table =
      fmt::format("{:<24}{:>12}     {:>9}  {:>10}\n", "parameter", "value", "std error", "change");
  data::for_each_parameter(calibration, [&](const std::string& name, const Parameter& p) {
    const data::ShownUnit as = data::shown_unit(p.unit);
    const double change = p.value - (nominal.contains(name) ? nominal[name] : 0);
    const int decimals = decimals_for(p.free ? p.std_error * as.factor : 0);
    const std::string error = p.free ? fmt::format("{:.{}f}", p.std_error * as.factor, decimals) : "";
    table +=
        fmt::format("{:<24}{:>12.{}f} {:<3} {:>9}  {:>+10.{}f}  {}\n", name, p.value * as.factor, decimals,
                    as.name, error, change * as.factor, decimals, remark(p, name, calibration, change));
  });
  table.pop_back();
  return table;
}

}  // namespace crisp::estimate
