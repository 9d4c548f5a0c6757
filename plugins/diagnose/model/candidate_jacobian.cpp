// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/candidate_jacobian.hpp"

#include <algorithm>
#include <map>
#include <numeric>

#include <crisp/term.hpp>

#include "pipeline/estimate/surfel_jacobian.hpp"

namespace crisp::diagnose {
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
    : candidates_(std::move(candidates)),
      terms_(terms),
      base_(base.size()),
      parameters_(base.size()),
      model_(model),
      free_(std::move(base)),
      columns_(base_),
      added_(model, {}) {
  for (const std::size_t parameter : free_) names_.push_back(model.names()[parameter]);
  std::iota(columns_.begin(), columns_.end(), std::size_t{0});
  for (std::size_t c = 0; c < candidates_.size(); ++c) add_columns(c);
  add_terms_of_model();
  added_ = terms_to_add();
}

void CandidateJacobian::add_columns(std::size_t candidate) {
  const Candidate& one = candidates_[candidate];
  const TermInfo& info = terms_.get(one.term.term)->info();
  const bool is_another_form = candidate > 0 && candidates_[candidate - 1].is_form_of(one);
  first_form_.push_back(is_another_form ? first_form_[candidate - 1] : candidate);
  auto& columns = of_.emplace_back();
  for (const std::size_t k : sizes(info)) {
    if (is_another_form && info.parameters[k].is_the_same_in_every_form) {
      columns.push_back(of_[first_form_[candidate]][columns.size()]);
      continue;
    }
    names_.push_back(one.name + "." + one.term.parameters[k].name);
    columns.push_back(parameters_++);
  }
}

void CandidateJacobian::add_terms_of_model() {
  const Calibration calibration = model_.calibration();
  for (std::size_t c = 0; c < candidates_.size(); ++c) {
    const Candidate& candidate = candidates_[c];
    if (!candidate.in_model) continue;
    const auto& present = terms_of(calibration, candidate.owner);
    const auto place = find_term(present, candidate.term.term) - present.data();
    const std::size_t first = first_slot(calibration, candidate.owner, static_cast<std::size_t>(place));
    const auto own = sizes(terms_.get(candidate.term.term)->info());
    for (std::size_t i = 0; i < own.size(); ++i) {
      free_.push_back(model_.chain(candidate.laser().value_or(0)).slots[first + own[i]]);
      columns_.push_back(of_[c][i]);
    }
  }
}

model::AddedTerms CandidateJacobian::terms_to_add() const {
  std::vector<std::vector<model::AddedTerm>> of_laser(model_.lasers());
  for (std::size_t c = 0; c < candidates_.size(); ++c) {
    const Candidate& candidate = candidates_[c];
    if (candidate.in_model) continue;
    model::AddedTerm added{
        .term = terms_.get(candidate.term.term), .values = {}, .parameters = {}, .columns = {}};
    for (const Parameter& parameter : candidate.term.parameters) added.values.push_back(parameter.value);
    const auto own = sizes(added.term->info());
    for (std::size_t i = 0; i < own.size(); ++i) {
      const bool is_of_first_form = first_form_[c] != c && of_[c][i] == of_[first_form_[c]][i];
      if (is_of_first_form) continue;
      added.parameters.push_back(own[i]);
      added.columns.push_back(of_[c][i]);
    }
    for (std::size_t laser = 0; laser < of_laser.size(); ++laser) {
      if (candidate.laser().value_or(laser) == laser) of_laser[laser].push_back(added);
    }
  }
  return {model_, of_laser};
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

void CandidateJacobian::add_prior(quality::NormalEquations& equations,
                                  const estimate::ParameterPrior& prior) const {
  const auto n = static_cast<Eigen::Index>(base_);
  const std::vector<std::size_t> base(free_.begin(), free_.begin() + n);
  const Eigen::VectorXd off = estimate::picked(model_, base) - estimate::centres_of(prior, model_, base);
  const Eigen::VectorXd information =
      equations.covariance_factor() * estimate::nominal_information(prior, model_, base);
  equations.matrix.diagonal().head(n) += information;
  equations.vector.head(n) += information.cwiseProduct(off);
  equations.chi2 += information.dot(off.cwiseAbs2());
}

quality::DerivativeRows CandidateJacobian::rows(const estimate::Sample& sample) const {
  return [this, &sample](const quality::Surfel& surfel, std::span<const std::uint32_t> beams,
                         std::span<const double> range_change, std::span<double> rows) {
    const Measurements met = estimate::with_range_changes(sample.beams, beams, range_change);
    estimate::fill_surfel_rows(model_, met, *sample.plate, free_, surfel.normal, columns_, parameters_, rows);
    added_.fill_rows(met, *sample.plate, surfel.normal, parameters_, rows);
  };
}

}  // namespace crisp::diagnose
