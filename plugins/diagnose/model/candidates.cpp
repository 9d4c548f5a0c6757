// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <crisp/effect_catalogue.hpp>

#include "plugins/diagnose/model/score_test.hpp"

namespace crisp::diagnose {
namespace {

double tried(const Tries& tries, double step, const Coverage& coverage) {
  const double share = tries.count > 1 ? std::clamp(step / (tries.count - 1), 0.0, 1.0) : 0.5;
  switch (tries.spacing) {
    case Tries::Spacing::kLinear:
      return std::lerp(tries.from, tries.to, share);
    case Tries::Spacing::kLogarithmic:
      return tries.from * std::pow(tries.to / tries.from, share);
    case Tries::Spacing::kRangePeriods: {
      const double longest = std::clamp(coverage.farthest, tries.from, tries.to);
      return 1 / std::lerp(1 / tries.from, 1 / longest, share);
    }
    case Tries::Spacing::kOfSimpleForm:
      return tries.from;
    case Tries::Spacing::kInstants:
      return std::lerp(coverage.first, coverage.last, std::lerp(tries.from, tries.to, share));
  }
  return 0;
}

/// Index of the parameter with a grid of forms; the number of parameters if there is none.
std::size_t form_of(const TermInfo& info) {
  const auto form = std::ranges::find_if(info.parameters, [](const auto& p) { return p.tries.count > 0; });
  return static_cast<std::size_t>(form - info.parameters.begin());
}

/// Value of a parameter of the cause's simple form, if the calibration has it.
std::optional<double> of_simple_form(const std::vector<TermParameters>& present, const std::string& family,
                                     const std::string& parameter) {
  const TermParameters* simple = find_term(present, family);
  if (!simple) return std::nullopt;
  const auto same = std::ranges::find(simple->parameters, parameter, &Parameter::name);
  return same != simple->parameters.end() ? std::optional(same->value) : std::nullopt;
}

/// The cause that is the level of a term's family; empty if there is none.
std::string level_of(const TermInfo& info, const TermRegistry& terms) {
  const std::string& family = family_of(info);
  return family.empty() ? std::string() : terms.get(family)->info().level;
}

/// Appends a term of one owner: as in the calibration, or in all of its forms.
void append(std::vector<Candidate>& all, Candidate as, const std::vector<TermParameters>& present,
            const ModelTerm& term, const Coverage& coverage) {
  const TermInfo& info = term.info();
  const std::size_t form = form_of(info);
  const bool has_forms = form < info.parameters.size();
  as.covariate = info.covariate;
  as.family = family_of(info);
  as.is_fine = info.is_fine;
  as.forms = has_forms ? static_cast<std::size_t>(info.parameters[form].tries.count) : 1;
  if (const TermParameters* here = find_term(present, info.name)) {
    as.term = *here;
    as.in_model = true;
    all.push_back(as);
    return;
  }
  as.term = neutral_parameters(info);
  if (has_forms && info.parameters[form].tries.spacing == Tries::Spacing::kOfSimpleForm) {
    const auto value = of_simple_form(present, as.family, info.parameters[form].name);
    if (!value) return;
    as.term.parameters[form].value = *value;
    all.push_back(as);
    return;
  }
  for (std::size_t step = 0; step < as.forms; ++step) {
    as.form = static_cast<double>(step);
    if (has_forms) as.term.parameters[form].value = tried(info.parameters[form].tries, as.form, coverage);
    all.push_back(as);
  }
}

}  // namespace

std::vector<TermParameters>& terms_of(Calibration& calibration, std::size_t owner) {
  return owner < calibration.lasers.size() ? calibration.lasers[owner].terms : calibration.plate_terms;
}
const std::vector<TermParameters>& terms_of(const Calibration& calibration, std::size_t owner) {
  return owner < calibration.lasers.size() ? calibration.lasers[owner].terms : calibration.plate_terms;
}

const TermParameters* find_term(const std::vector<TermParameters>& terms, const std::string& name) {
  const auto found = std::ranges::find(terms, name, &TermParameters::term);
  return found == terms.end() ? nullptr : &*found;
}

std::vector<Candidate> candidates(const TermRegistry& terms, const Calibration& calibration,
                                  const Coverage& coverage) {
  std::vector<Candidate> all;
  for (const std::string& name : terms.names()) {
    const auto term = terms.get(name);
    if (term->info().is_nuisance || !coverage.shares(term->info().counts_from)) continue;
    const std::string level = level_of(term->info(), terms);
    if (term->info().scope == Scope::kPlate) {
      append(all, {.owner = calibration.lasers.size(), .name = name, .level = level}, calibration.plate_terms,
             *term, coverage);
      continue;
    }
    for (std::size_t laser = 0; laser < calibration.lasers.size(); ++laser) {
      const LaserCalibration& own = calibration.lasers[laser];
      append(all, {.owner = laser, .name = own.name + "." + name, .level = level}, own.terms, *term,
             coverage);
    }
  }
  return all;
}

std::vector<std::string> unshared_causes(const TermRegistry& terms, const Coverage& coverage) {
  std::vector<std::string> causes;
  for (const std::string& name : terms.names()) {
    const TermInfo& info = terms.get(name)->info();
    const bool is_cause =
        !info.is_nuisance && info.covariate.empty() && info.family.empty();  // not one more form of another
    if (is_cause && !coverage.shares(info.counts_from)) causes.push_back(name);
  }
  return causes;
}

Candidate in_form(Candidate candidate, double step, const TermRegistry& terms, const Coverage& coverage) {
  const auto term = terms.get(candidate.term.term);
  const std::size_t form = form_of(term->info());
  candidate.form = step;
  candidate.term.parameters.at(form).value = tried(term->info().parameters[form].tries, step, coverage);
  return candidate;
}

Candidate with_estimates(Candidate candidate, const ScoreTest& test, const TermRegistry& terms) {
  const auto term = terms.get(candidate.term.term);
  const auto& parameters = term->info().parameters;
  Eigen::Index k = 0;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (parameters[i].shape) continue;
    candidate.term.parameters[i].value =
        std::clamp(parameters[i].neutral + test.value[k++], parameters[i].lower, parameters[i].upper);
  }
  return candidate;
}

void add_to(Calibration& calibration, const Candidate& candidate) {
  terms_of(calibration, candidate.owner).push_back(candidate.term);
}

Calibration with_terms(Calibration calibration, const std::vector<Candidate>& chosen,
                       const TermRegistry& terms) {
  const auto is_tested = [&](const TermParameters& one) { return !terms.get(one.term)->info().is_nuisance; };
  for (auto& laser : calibration.lasers) std::erase_if(laser.terms, is_tested);
  std::erase_if(calibration.plate_terms, is_tested);
  for (const Candidate& candidate : chosen) add_to(calibration, candidate);
  return calibration;
}

std::vector<Candidate> with_values_of(const Calibration& calibration, std::vector<Candidate> chosen) {
  for (Candidate& candidate : chosen) {
    const TermParameters* found = find_term(terms_of(calibration, candidate.owner), candidate.term.term);
    if (found) candidate.term = *found;
  }
  return chosen;
}

}  // namespace crisp::diagnose
