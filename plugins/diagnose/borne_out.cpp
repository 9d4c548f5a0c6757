// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/borne_out.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <map>
#include <string>

#include "pipeline/statistics/dense_solvers.hpp"

namespace crisp {
namespace {

constexpr const char* kMayBeTheScenes =
    "several lasers have it alike, and it is small: surfaces that are not as flat as they are taken for make "
    "as much";
constexpr const char* kIsNothing =
    "with the others that are accepted it comes out as nothing, within its standard errors";

/// The chance that a term which does nothing comes out as this one or farther off; 0 where nothing of it was
/// estimated.
double chance_of_neutral(const Candidate& candidate, const Outcome& outcome, const TermInfo& info) {
  const auto places = places_of(candidate, outcome);
  std::vector<Eigen::Index> at;
  std::vector<double> off;
  for (std::size_t p = 0; p < places.size(); ++p) {
    if (!places[p] || info.parameters[p].shape) continue;
    at.push_back(*places[p]);
    off.push_back(
        outcome.model
            .values()[static_cast<Eigen::Index>(outcome.free[static_cast<std::size_t>(*places[p])])] -
        info.parameters[p].neutral);
  }
  if (at.empty()) return 0;
  const Eigen::MatrixXd covariance = outcome.covariance(at, at);
  const Eigen::VectorXd change =
      Eigen::Map<const Eigen::VectorXd>(off.data(), static_cast<Eigen::Index>(off.size()));
  const double square = change.dot(solve_positive_definite(covariance, change));
  if (!(square > 0)) return 1;
  return cdf(complement(boost::math::chi_squared(static_cast<double>(off.size())), square));
}

}  // namespace

std::vector<std::optional<Eigen::Index>> places_of(const Candidate& candidate, const Outcome& outcome) {
  std::vector<std::optional<Eigen::Index>> places(candidate.term.parameters.size());
  for (std::size_t p = 0; p < places.size(); ++p) {
    const std::string name =
        (candidate.laser() ? "" : "plate.") + candidate.name + "." + candidate.term.parameters[p].name;
    for (std::size_t k = 0; k < outcome.free.size(); ++k) {
      if (outcome.model.names()[outcome.free[k]] == name) places[p] = static_cast<Eigen::Index>(k);
    }
  }
  return places;
}

void refuse_what_may_be_the_scenes(std::vector<Departure>& departures) {
  constexpr double kOfScenes = 0.1;  // [σ] RMS
  std::map<std::string, std::vector<Departure*>> alike;
  for (Departure& one : departures) {
    if (one.accepted && one.candidate.laser()) alike[one.candidate.term.term].push_back(&one);
  }
  for (const auto& [term, some] : alike) {
    const bool is_large =
        std::ranges::any_of(some, [](const Departure* one) { return one->look.visible > kOfScenes; });
    if (some.size() < 2 || is_large) continue;
    for (Departure* one : some) one->refuse(kMayBeTheScenes);
  }
}

bool refuse_what_is_not_borne_out(std::vector<Departure>& departures, const Outcome& outcome,
                                  const TermRegistry& terms, double p_value) {
  bool refuses = false;
  for (Departure& one : departures) {
    if (!one.accepted) continue;
    const TermInfo& info = terms.get(one.candidate.term.term)->info();
    if (chance_of_neutral(one.candidate, outcome, info) < p_value) continue;
    one.refuse(kIsNothing);
    refuses = true;
  }
  return refuses;
}

}  // namespace crisp
