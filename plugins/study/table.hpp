// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "plugins/study/monte_carlo_trial.hpp"

namespace crisp::study {

/// How estimates of one kind of parameter lie about the truth.
struct Scatter {
  double mean = 0;       ///< error
  double std_dev = 0;    ///< of the error
  double estimated = 0;  ///< RMS of the standard errors that the estimator gave itself; 0 where it gave none
  double one = 0;        ///< share of errors within 1 of these;
  double two = 0;        ///< within 1.96
  std::size_t estimates =
      0;  ///< that were counted: without any, the figures are none. Not known of the paper's
};

/// One row of Table 1, all lasers together. In the unit that is named.
struct ErrorRow {
  std::string parameter;         ///< "tau"
  std::string unit;              ///< "mm"
  std::optional<Scatter> paper;  ///< Table 1 of the paper, where it is known
  std::optional<Scatter> rqe;    ///< where it was run
  Scatter refined;
  double bound = 0;             ///< Cramér–Rao: RMS over runs and lasers
  double bound_with_steps = 0;  ///< likewise, the steps of the encoder counted as noise
};

/// Table 1 of Sheehan, Harrison and Newman, made anew.
struct Table {
  std::vector<ErrorRow> rows;  ///< λ, τ, α, η; those that were estimated
  std::size_t runs = 0;
  std::size_t rqe_astray =
      0;  ///< runs left out of the estimator's columns: they ended in another local minimum,
  std::size_t refined_astray = 0;  ///< some parameter being off by more than 5 cm, 5° or 20 ms,
  std::size_t refined_failed = 0;  ///< or without an estimate
};

/// @param papers  whether the trials are those of the paper, so that its figures are shown next to them
Table table_of(const std::vector<MonteCarloTrial>& trials, bool papers = true);

/// Whether any run was refined, and ended in the true minimum.
bool reports_refinement(const Table& table);

/// For people.
std::string table_text(const Table& table);

/// Every run, a line a parameter:
/// "seed,parameter,unit,bound,bound_with_steps,rqe_error,error,std_error,failure", SI.
std::string runs_csv(const std::vector<MonteCarloTrial>& trials);

}  // namespace crisp::study
