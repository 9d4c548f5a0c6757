// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/candidate_jacobian.hpp"

#include <algorithm>
#include <map>
#include <numeric>

#include "pipeline/estimate/surfel_jacobian.hpp"
#include "pipeline/model/beam.hpp"

namespace crisp {
namespace {

constexpr std::size_t kOfEquationTwo = 4;  // λ, τ, α, η: the first parameters of a laser's chain

/// Indices of a term's size parameters.
std::vector<std::size_t> sizes(const TermInfo& info) {
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < info.parameters.size(); ++i) {
    if (!info.parameters[i].shape) result.push_back(i);
  }
  return result;
}

/// Index of a term's first parameter in its owner's chain. The laser's terms come first, in the order of the
/// calibration, then the plate's.
std::size_t first_slot(const Calibration& calibration, std::size_t owner, std::size_t term) {
  const bool is_plate = owner == calibration.lasers.size();
  const auto& own = calibration.lasers[is_plate ? 0 : owner].terms;
  std::size_t slot = kOfEquationTwo;
  for (std::size_t i = 0; i < (is_plate ? own.size() : term); ++i) slot += own[i].parameters.size();
  for (std::size_t i = 0; is_plate && i < term; ++i) slot += calibration.plate_terms[i].parameters.size();
  return slot;
}

}  // namespace

CandidateJacobian::CandidateJacobian(const SensorModel& model, std::vector<std::size_t> base,
                                     std::vector<Candidate> candidates, const TermRegistry& terms)
    : candidates_(std::move(candidates)), terms_(terms), base_(base.size()), parameters_(base.size()) {
  for (const std::size_t parameter : base) names_.push_back(model.names()[parameter]);
  for (std::size_t c = 0; c < candidates_.size(); ++c) add_columns(c);
  std::vector<std::size_t> columns(base_);
  std::iota(columns.begin(), columns.end(), std::size_t{0});
  pages_.push_back({.model = model, .free = std::move(base), .columns = std::move(columns)});
  for (const auto& page : pages_of(model.lasers())) add_page(model, page);
  // Each beam is of one laser, so groups of different lasers cost no more than one of them.
  for (std::size_t k = 0;; ++k) {
    std::vector<std::size_t> some;
    for (std::size_t laser = 0; laser < model.lasers(); ++laser) {
      const auto own = pages_of(laser);
      if (k < own.size()) some.insert(some.end(), own[k].begin(), own[k].end());
    }
    if (some.empty()) break;
    add_page(model, some);
  }
}

void CandidateJacobian::add_columns(std::size_t candidate) {
  const Candidate& one = candidates_[candidate];
  const TermInfo& info = terms_.get(one.term.term)->info();
  const bool is_another_form = candidate > 0 && candidates_[candidate - 1].is_form_of(one);
  first_form_.push_back(is_another_form ? first_form_[candidate - 1] : candidate);
  owned_.push_back(0);
  auto& columns = of_.emplace_back();
  for (const std::size_t k : sizes(info)) {
    if (is_another_form && info.parameters[k].is_the_same_in_every_form) {
      columns.push_back(of_[first_form_[candidate]][columns.size()]);
      continue;
    }
    names_.push_back(one.name + "." + one.term.parameters[k].name);
    columns.push_back(parameters_++);
    ++owned_[candidate];
  }
}

/// Groups the candidates of one owner by what one pass of automatic differentiation takes.
std::vector<std::vector<std::size_t>> CandidateJacobian::pages_of(std::size_t owner) const {
  std::vector<std::vector<std::size_t>> pages;
  std::size_t taken = 0;
  for (std::size_t c = 0; c < candidates_.size(); ++c) {
    if (candidates_[c].owner != owner) continue;
    if (pages.empty() || taken + owned_[c] > static_cast<std::size_t>(Jet::DIMENSION)) {
      pages.emplace_back();
      taken = 0;
    }
    pages.back().push_back(c);
    taken += owned_[c];
  }
  return pages;
}

void CandidateJacobian::add_page(const SensorModel& model, const std::vector<std::size_t>& some) {
  const Calibration before = model.calibration();
  Calibration calibration = before;
  std::map<std::size_t, std::size_t> added;  // number of added terms, by owner
  std::vector<std::size_t> place;            // index of each candidate among its owner's terms
  for (const std::size_t c : some) {
    const Candidate& candidate = candidates_[c];
    if (candidate.in_model) {
      const auto& own = terms_of(before, candidate.owner);
      place.push_back(static_cast<std::size_t>(find_term(own, candidate.term.term) - own.data()));
      continue;
    }
    place.push_back(terms_of(before, candidate.owner).size() + added[candidate.owner]++);
    add_to(calibration, candidate);
  }
  Page page{.model = SensorModel(calibration, terms_), .free = {}, .columns = {}};
  for (std::size_t k = 0; k < some.size(); ++k) {
    const Candidate& candidate = candidates_[some[k]];
    const auto& slots = page.model.chain(candidate.laser().value_or(0)).slots;
    const std::size_t first = first_slot(calibration, candidate.owner, place[k]);
    const auto own = sizes(terms_.get(candidate.term.term)->info());
    const std::size_t first_form = first_form_[some[k]];
    for (std::size_t i = 0; i < own.size(); ++i) {
      const std::size_t column = of_[some[k]][i];
      if (first_form != some[k] && column == of_[first_form][i]) continue;
      page.free.push_back(slots[first + own[i]]);
      page.columns.push_back(column);
    }
  }
  pages_.push_back(std::move(page));
}

Eigen::VectorXd CandidateJacobian::sizes_of(std::size_t candidate) const {
  const TermInfo& info = terms_.get(candidates_[candidate].term.term)->info();
  const auto own = sizes(info);
  Eigen::VectorXd values(static_cast<Eigen::Index>(own.size()));
  for (std::size_t i = 0; i < own.size(); ++i) {
    values[static_cast<Eigen::Index>(i)] =
        candidates_[candidate].term.parameters[own[i]].value - info.parameters[own[i]].neutral;
  }
  return values;
}

DerivativeRows CandidateJacobian::rows(const Sample& sample) const {
  return [this, &sample](const Surfel& surfel, std::span<const std::uint32_t> beams,
                         std::span<const double> range_change, std::span<double> rows) {
    std::vector<double> some;
    for (const Page& page : pages_) {
      some.assign(beams.size() * page.free.size(), 0);
      surfel_rows(page.model, sample, page.free)(surfel, beams, range_change, some);
      for (std::size_t i = 0; i < beams.size(); ++i) {
        for (std::size_t k = 0; k < page.columns.size(); ++k) {
          rows[i * parameters_ + page.columns[k]] = some[i * page.columns.size() + k];
        }
      }
    }
  };
}

}  // namespace crisp
