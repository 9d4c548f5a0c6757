// SPDX-License-Identifier: BSD-3-Clause
// How often the diagnosis names what hides in recordings: the long suite, of which the tests run a small
// draw. Prints a line for each recording, and a table in the end.
//
//     hidden_trial WHAT [SEEDS [FIRST [MILLIMETRES [EFFECT]]]]
//
// WHAT hides: `one` effect of the catalogue (SEEDS recordings of each), `two` or `three` at once, `none`, or
// something `else` that no effect describes. MILLIMETRES: RMS by which each changes ranges (8).
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <map>
#include <span>

#include "tests/plugins/diagnose/noise/drawn.hpp"
#include "tests/plugins/diagnose/true_gain.hpp"
#include "tests/plugins/diagnose/unmodeled_errors.hpp"

namespace crisp {
namespace {

using namespace crisp::diagnose;
using namespace crisp::estimate;
using test::causes;
using test::Drawer;
using test::Drawn;
using test::stands_for;

/// What became of one recording.
struct Outcome {
  std::size_t hidden = 0, named = 0, in_class = 0;
  std::size_t all_named = 0, all_in_class = 0;  ///< 1 if all that hides has its name; its name or its class
  std::size_t in_span = 0;                      ///< reported, by name, as absorbed by the other parameters
  std::size_t said_small = 0;                   ///< reported, by name, as below these data's resolution
  std::size_t wrong = 0, unnamed = 0, right_covariate = 0;
  std::size_t is_described = 0;  ///< 1 if an unmodeled error is reported with its covariate
  std::size_t parameters = 0, within_three = 0;
  std::size_t gains = 0;         ///< of recordings in which one cause was found and paid
  std::size_t gain_covered = 0;  ///< intervals of these in which the true gain in thickness lies
  std::size_t as_thin = 0;       ///< clouds within 3 % of the one where nothing hides
};

void count_hidden(const Drawn& drawn, const Diagnosis& diagnosis, const std::string& name, Outcome& outcome) {
  ++outcome.hidden;
  const auto taken = [&](auto matches) {
    return std::ranges::any_of(diagnosis.hypotheses, [&](const Hypothesis& hypothesis) {
      return hypothesis.accepted && hypothesis.candidate.is_cause() && matches(hypothesis);
    });
  };
  if (taken([&](const Hypothesis& hypothesis) { return hypothesis.candidate.cause_name() == name; })) {
    ++outcome.named;
    for (const auto& reported : test::estimates_of(diagnosis, drawn.recording.scanner.truth, name)) {
      ++outcome.parameters;
      outcome.within_three += std::abs(reported.error()) < 3 ? 1 : 0;
    }
  } else if (taken([&](const Hypothesis& hypothesis) { return stands_for(hypothesis, name); })) {
    ++outcome.in_class;
  } else if (const auto limit = std::ranges::find(diagnosis.unobservable, name, &Limit::name);
             limit != diagnosis.unobservable.end()) {
    ++(std::isfinite(limit->size) ? outcome.said_small : outcome.in_span);
  }
}

/// Whether an error without a cause is reported with its covariate: as an accepted shape, or as a residual.
bool is_described(const Drawn& drawn, const Diagnosis& diagnosis) {
  return std::ranges::any_of(diagnosis.hypotheses,
                             [&](const Hypothesis& hypothesis) {
                               return hypothesis.accepted && !hypothesis.candidate.is_cause() &&
                                      hypothesis.candidate.covariate == drawn.covariate;
                             }) ||
         std::ranges::any_of(diagnosis.left_after.profiles, [&](const Profile& profile) {
           return profile.is_significant() && profile.covariate == drawn.covariate;
         });
}

Outcome outcome_of(const Drawn& drawn, const Diagnosis& diagnosis) {
  Outcome outcome;
  for (const std::string& name : drawn.names) count_hidden(drawn, diagnosis, name, outcome);
  const auto is_all = [&](std::size_t count) { return outcome.hidden > 0 && count == outcome.hidden; };
  outcome.all_named = is_all(outcome.named) ? 1 : 0;
  outcome.all_in_class = is_all(outcome.named + outcome.in_class) ? 1 : 0;
  for (const Hypothesis& hypothesis : diagnosis.hypotheses) {
    if (!hypothesis.accepted) continue;
    if (hypothesis.candidate.is_cause()) {
      const bool right = std::ranges::any_of(drawn.names, [&](const std::string& name) {
        return hypothesis.candidate.cause_name() == name || stands_for(hypothesis, name);
      });
      outcome.wrong += right ? 0 : 1;
    } else {
      ++outcome.unnamed;
      outcome.right_covariate += hypothesis.candidate.covariate == drawn.covariate ? 1 : 0;
    }
  }
  outcome.is_described = is_described(drawn, diagnosis) ? 1 : 0;
  return outcome;
}

/// The gain of the one identified cause on held-out turns, compared with the truth's gain.
std::string judge_gain(const Drawn& drawn, const Drawn& clean, const Diagnosis& diagnosis, Outcome& outcome) {
  if (diagnosis.hypotheses.size() != 1 || !diagnosis.hypotheses[0].accepted) return {};
  const Gain& gain = diagnosis.hypotheses[0].gains.at(0);
  const auto truly = test::true_thickness(drawn.recording, clean.recording, diagnosis.before.outcome.model);
  const double change = truly.with_truth - gain.before;
  const bool covered = gain.ci95[0] <= change && change <= gain.ci95[1];
  ++outcome.gains;
  outcome.gain_covered += covered ? 1 : 0;
  outcome.as_thin += std::abs(gain.after - truly.clean) <= 0.03 * truly.clean ? 1 : 0;
  return fmt::format(
      "    thickness {:.3f} to {:.3f} mm, with the truth {:.3f} mm ({}), where nothing hides {:.3f} mm\n",
      1e3 * gain.before, 1e3 * gain.after, 1e3 * truly.with_truth,
      covered ? "within the interval" : "OUTSIDE the interval", 1e3 * truly.clean);
}

std::string found_by(const Diagnosis& diagnosis) {
  const double noise = RefinementSettings{}.surfels.noise;
  std::string words;
  for (const Hypothesis& hypothesis : diagnosis.hypotheses) {
    words +=
        fmt::format(" {} ({:.2f} mm)", hypothesis.candidate.name, 1e3 * std::sqrt(hypothesis.square(noise)));
    if (!hypothesis.rejected.empty()) {
      words += fmt::format("(rejected: {})", hypothesis.rejected);
    } else if (!hypothesis.accepted && !hypothesis.gains.empty()) {
      const Gain& gain = *std::ranges::find(hypothesis.gains, "log-likelihood a measurement", &Gain::metric);
      words += fmt::format("(refused: {:+.5f} to {:+.5f})", gain.ci95[0], gain.ci95[1]);
    }
    for (const auto& competitor : hypothesis.competitors) {
      if (competitor.behind < SelectionSettings{}.odds) words += "|" + competitor.name;
    }
  }
  return words.empty() ? " nothing" : words;
}

struct Row {
  std::size_t recordings = 0, settled = 0;
  Outcome sum;

  void add(const Outcome& one, bool is_settled) {
    ++recordings;
    settled += is_settled ? 1 : 0;
    for (auto part :
         {&Outcome::hidden, &Outcome::named, &Outcome::in_class, &Outcome::all_named, &Outcome::all_in_class,
          &Outcome::in_span, &Outcome::said_small, &Outcome::wrong, &Outcome::unnamed,
          &Outcome::right_covariate, &Outcome::is_described, &Outcome::parameters, &Outcome::within_three,
          &Outcome::gains, &Outcome::gain_covered, &Outcome::as_thin}) {
      sum.*part += one.*part;
    }
  }
};

class Trial {
 public:
  /// @param clean  of the same seed, with nothing hidden; null if gains are not judged
  void run(const std::string& what, const Drawn& drawn, double size, const Drawn* clean = nullptr) {
    if (!drawn.reaches(size)) {
      fmt::print("{:<26} seed {:<4} cannot be so large within its bounds: {:.1f} mm\n", what,
                 drawn.recording.scanner.seed, 1e3 * std::ranges::min(drawn.sizes));
      return;
    }
    const auto begin = std::chrono::steady_clock::now();
    const Diagnosis diagnosis = test::diagnosed(drawn.recording);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    Outcome outcome = outcome_of(drawn, diagnosis);
    const std::string gain = clean == nullptr ? "" : judge_gain(drawn, *clean, diagnosis, outcome);
    rows_[what].add(outcome, diagnosis.settled);
    std::string errors;
    for (const std::string& name : drawn.names) {
      for (const auto& reported : test::estimates_of(diagnosis, drawn.recording.scanner.truth, name)) {
        errors += fmt::format(" {:+.1f}", reported.error());
        if (std::abs(reported.error()) < 3) continue;
        errors += fmt::format(" ({} = {:.4g} ± {:.1g}, is {:.4g})", reported.name, reported.estimate,
                              reported.std_error, reported.truth);
      }
    }
    std::string hidden = drawn.covariate;
    for (std::size_t k = 0; k < drawn.names.size(); ++k) {
      hidden += fmt::format(" {} ({:.1f} mm)", drawn.names[k], 1e3 * drawn.sizes[k]);
    }
    fmt::print(
        "{:<26} seed {:<4} {:<6} {} lasers {:<9} hidden:{}; found:{}; errors{}; p {:.3f} {:.3f}; noise {:.3f} {:.3f} mm; {:.0f} s{}\n",
        what, drawn.recording.scanner.seed, drawn.scene, drawn.recording.scanner.rig.lasers.size(),
        drawn.motion, hidden, found_by(diagnosis), errors, diagnosis.left_before.p_value,
        diagnosis.left_after.p_value, 1e3 * std::ranges::max(diagnosis.left_before.noise),
        1e3 * std::ranges::max(diagnosis.left_after.noise), seconds.count(),
        diagnosis.settled ? "" : "; NOT SETTLED");
    fmt::print("{}", gain);
    for (const Profile& profile : diagnosis.left_after.profiles) {
      if (!profile.is_significant()) continue;
      const bool of_all = profile.laser == kAllLasers;
      fmt::print("    left: {} over {}, {:.3f} mm, p {:.3f}\n",
                 of_all ? "scanner" : fmt::format("laser{}", profile.laser + 1), profile.covariate,
                 1e3 * profile.rms, profile.p_value);
    }
    for (const auto& limit : diagnosis.unobservable) {
      if (std::ranges::count(drawn.names, limit.name) > 0) {
        fmt::print("    {} would not show below {:.1f} mm\n", limit.name, 1e3 * limit.size);
      }
    }
    std::fflush(stdout);
  }

  void print() const {
    fmt::print(
        "\n| what hides | recordings | all named | all named or in their class | hidden | named | its class | the base's class | reported as too small | wrong names | unnamed | of these right | recordings with the right covariate | parameters within 3 s.e. | gains whose interval covers the true one | clouds within 3 % of a clean one |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    Row all;
    for (const auto& [what, row] : rows_) {
      print(what, row);
      all.add(row.sum, true);
      all.recordings += row.recordings - 1;
    }
    print("all", all);
  }

 private:
  static void print(const std::string& what, const Row& row) {
    const Outcome& s = row.sum;
    fmt::print(
        "| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} of {} | {} of {} | {} of {} |\n",
        what, row.recordings, s.all_named, s.all_in_class, s.hidden, s.named, s.in_class, s.in_span,
        s.said_small, s.wrong, s.unnamed, s.right_covariate, s.is_described, s.within_three, s.parameters,
        s.gain_covered, s.gains, s.as_thin, s.gains);
  }
  std::map<std::string, Row> rows_;
};

struct Wanted {
  std::string what = "one";
  std::uint64_t seeds = 10;
  std::uint64_t first = 1;
  double size = 0.008;
  std::string effect;  // empty: all
};

void run(const Wanted& requested) {
  Trial trial;
  const std::uint64_t end = requested.first + requested.seeds;
  for (std::uint64_t seed = requested.first; seed < end; ++seed) {
    if (requested.what == "one") {
      std::uint64_t k = 0;
      for (const std::string& effect : causes()) {
        const std::uint64_t own = seed + 1000 * ++k;
        if (!requested.effect.empty() && effect != requested.effect) continue;
        const Drawn clean = Drawer(own).with({}, 0);
        trial.run(effect, Drawer(own).with({effect}, requested.size), requested.size, &clean);
      }
    } else if (requested.what == "else") {
      for (std::size_t k = 0; k < test::something_else().size(); ++k) {
        if (!requested.effect.empty() && requested.effect != std::to_string(k)) continue;
        trial.run(fmt::format("else {}", k), Drawer(seed + 1000 * k).with_something_else(k, requested.size),
                  requested.size);
      }
    } else {
      const std::size_t count = requested.what == "three" ? 3 : requested.what == "two" ? 2 : 0;
      trial.run(requested.what, Drawer(seed).with(test::some_causes(count, seed), requested.size),
                requested.size);
    }
  }
  trial.print();
}

}  // namespace
}  // namespace crisp

int main(int argc, char** argv) {
  const std::span<char*> arguments(argv, static_cast<std::size_t>(argc));
  crisp::Wanted requested;
  if (arguments.size() > 1) requested.what = arguments[1];
  if (arguments.size() > 2) requested.seeds = std::strtoull(arguments[2], nullptr, 10);
  if (arguments.size() > 3) requested.first = std::strtoull(arguments[3], nullptr, 10);
  if (arguments.size() > 4) requested.size = std::strtod(arguments[4], nullptr) / 1e3;
  if (arguments.size() > 5) requested.effect = arguments[5];
  try {
    crisp::run(requested);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
