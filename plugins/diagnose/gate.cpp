// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/gate.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace crisp {
namespace {

/// Whether the likelihood of held-out turns rises; by how little for sure is told, but no reason to refuse
/// what is significant on the others.
bool pays(const std::vector<Gain>& gains) {
  const auto likelihood = std::ranges::find(gains, HeldOut::kLikelihood, &Gain::metric);
  return likelihood != gains.end() && likelihood->after > likelihood->before;
}

/// What was accepted so far.
class Gate {
 public:
  Gate(const HeldOut& held_out, HeldOut::Score plain, const Calibration& found, const RefinedOn& refined)
      : held_out_(held_out), found_(found), refined_(refined), score_(std::move(plain)) {}

  /// Whether some departures pay together; if so, they are part of the model from then on.
  bool accepts(const std::vector<Departure*>& some) {
    auto tried = accepted_;
    for (const Departure* departure : some) tried.push_back(departure->candidate);
    tried = with_values_of(found_, tried);
    auto score = held_out_.score(refined_(with_terms(found_, tried), held_out_.fitted()));
    const auto gains = HeldOut::gains(score_, score);
    const bool is_paid = pays(gains);
    for (Departure* departure : some) {
      if (some.size() > 1 && !is_paid) continue;  // that of each by itself is told
      departure->gains = gains;
      departure->accepted = is_paid;
    }
    if (!is_paid) return false;
    accepted_ = std::move(tried);
    score_ = std::move(score);
    return true;
  }

 private:
  const HeldOut& held_out_;
  const Calibration& found_;
  const RefinedOn& refined_;
  std::vector<Candidate> accepted_;
  HeldOut::Score score_;
};

}  // namespace

void accept_what_pays(const HeldOut& held_out, std::vector<Departure>& departures,
                      const HeldOut::Score& plain, const Calibration& found, const RefinedOn& refined) {
  Gate gate(held_out, plain, found, refined);
  std::vector<Departure*> open;
  for (Departure& departure : departures) {
    if (departure.accepted) open.push_back(&departure);
  }
  while (!open.empty()) {
    std::vector<Departure*> alike;
    std::ranges::copy_if(open, std::back_inserter(alike), [&](const Departure* other) {
      return other->candidate.term.term == open.front()->candidate.term.term;
    });
    std::vector<Departure*> judged = {open.front()};
    if (!gate.accepts(judged) && alike.size() > 1 && gate.accepts(alike)) judged = alike;
    std::erase_if(open, [&](Departure* one) { return std::ranges::find(judged, one) != judged.end(); });
  }
}

}  // namespace crisp
