// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/forms.hpp"

#include <algorithm>
#include <numeric>

#include "plugins/diagnose/selection.hpp"

namespace crisp {
namespace {

/// The best of some forms of one candidate beside the others.
std::size_t best_of(const std::vector<Candidate>& forms, const std::vector<Candidate>& others,
                    const SensorModel& model, const std::vector<std::size_t>& base, const Evidence& evidence,
                    const TermRegistry& terms) {
  std::vector<Candidate> all = forms;
  all.insert(all.end(), others.begin(), others.end());
  std::vector<std::size_t> taken(others.size());
  std::iota(taken.begin(), taken.end(), forms.size());
  const Dictionary dictionary(model, base, all, terms);
  const auto looks =
      looks_beside(taken, dictionary, from_neutral(dictionary, evidence.equations(dictionary)));
  std::size_t best = 0;
  for (std::size_t k = 1; k < forms.size(); ++k) {
    if (looks[k]->gain > looks[best]->gain) best = k;
  }
  return best;
}

}  // namespace

std::vector<Candidate> with_sharper_forms(std::vector<Candidate> chosen, const SensorModel& model,
                                          const std::vector<std::size_t>& base, const Evidence& evidence,
                                          const TermRegistry& terms) {
  constexpr int kZooms = 3;
  constexpr int kHalf = 4;  // forms to either side
  for (std::size_t c = 0; c < chosen.size(); ++c) {
    if (chosen[c].in_model || chosen[c].forms < 2) continue;
    std::vector<Candidate> others = chosen;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(c));
    double step = 1;
    for (int zoom = 0; zoom < kZooms; ++zoom) {
      step /= kHalf;
      std::vector<Candidate> forms;
      for (int k = -kHalf; k <= kHalf; ++k) {
        forms.push_back(in_form(chosen[c], chosen[c].form + k * step, terms, evidence.lasting()));
      }
      chosen[c] = forms[best_of(forms, others, model, base, evidence, terms)];
    }
  }
  return chosen;
}

}  // namespace crisp
