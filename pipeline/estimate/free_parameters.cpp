// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/free_parameters.hpp"

#include <algorithm>
#include <array>

#include <crisp/error.hpp>

#include "pipeline/estimate/requested_terms.hpp"

namespace crisp::estimate {
namespace {

constexpr const char* kNoBeams =
    "there are no beams of this laser: it measured nothing, or a stage above removed them";
constexpr std::array kKinds = {"lambda", "tau", "alpha", "eta"};  // in the order of a chain's slots

bool is_fixed(const std::string& name, const std::vector<std::string>& fixed) {
  return std::any_of(fixed.begin(), fixed.end(),
                     [&](const std::string& f) { return name == f || name.ends_with("." + f); });
}

/// Which lasers fired these beams.
std::vector<bool> lasers_in(const Measurements& beams, std::size_t lasers) {
  std::vector<bool> seen(lasers, false);
  for (const auto laser : beams.laser) {
    if (laser < lasers) seen[laser] = true;
  }
  return seen;
}

/// Whether a parameter is of the chain of a laser that measured something.
bool feels(const SensorModel& model, const std::vector<bool>& measured, std::size_t parameter) {
  for (std::size_t laser = 0; laser < model.lasers(); ++laser) {
    const auto& slots = model.chain(laser).slots;
    if (measured[laser] && std::ranges::find(slots, parameter) != slots.end()) return true;
  }
  return false;
}

}  // namespace

FreeParameters free_parameters(const SensorModel& model, const Measurements& beams,
                               const std::vector<std::string>& fixed, const std::vector<std::string>& terms,
                               bool forms) {
  const std::vector<bool> measured = lasers_in(beams, model.lasers());
  FreeParameters result;
  bool gauge = false;
  for (std::size_t laser = 0; laser < model.lasers(); ++laser) {
    for (std::size_t kind = 0; kind < kKinds.size(); ++kind) {
      const std::size_t slot = model.chain(laser).slots[kind];
      const std::string& name = model.names()[slot];
      if (!measured[laser]) {
        result.unobservable.push_back({.parameter = name, .reason = kNoBeams, .combination = {}});
      } else if (kind == 0 && !gauge) {
        gauge = true;
      } else if (!is_fixed(name, fixed)) {
        result.free.push_back(slot);
      }
    }
  }
  for (const std::size_t parameter : parameters_of(model, terms, forms)) {
    if (feels(model, measured, parameter)) {
      result.free.push_back(parameter);
    } else {
      result.unobservable.push_back(
          {.parameter = model.names()[parameter], .reason = kNoBeams, .combination = {}});
    }
  }
  return result;
}

void check_fixed(const std::vector<std::string>& fixed, const Calibration& calibration) {
  for (const std::string& name : fixed) {
    const bool known = std::any_of(kKinds.begin(), kKinds.end(), [&](const std::string& kind) {
      return name == kind ||
             std::any_of(calibration.lasers.begin(), calibration.lasers.end(),
                         [&](const LaserCalibration& laser) { return name == laser.name + "." + kind; });
    });
    if (!known) {
      throw Error(
          "\"" + name + "\" is no parameter that can be held",
          "name one as laser1.eta, or as eta for all lasers; the parameters are lambda, tau, alpha and eta");
    }
  }
}

LagRange lag_range(const SensorModel& model, double margin) {
  constexpr std::size_t kEta = 3;
  LagRange range;
  for (std::size_t laser = 0; laser < model.lasers(); ++laser) {
    const double eta = model.values()[static_cast<Eigen::Index>(model.chain(laser).slots[kEta])];
    if (laser == 0) range = {.earliest = eta, .latest = eta};
    range = {.earliest = std::min(range.earliest, eta), .latest = std::max(range.latest, eta)};
  }
  return {.earliest = range.earliest - margin, .latest = range.latest + margin};
}

}  // namespace crisp::estimate
