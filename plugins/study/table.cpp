// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/study/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pipeline/data/degree.hpp"
#include "plugins/study/parameter_kind.hpp"

namespace crisp::study {
namespace {

/// Table 1 of the paper.
std::optional<Scatter> in_the_paper(const std::string& name) {
  if (name == "tau") return Scatter{.mean = 2.1, .std_dev = 0.6};
  if (name == "alpha") return Scatter{.mean = 0.06, .std_dev = 0.12};
  return {};
}

/// [SI] Larger errors belong to another local minimum.
double astray(const ParameterKind& kind) {
  if (kind.si == "rad") return 5 * data::kDegree;
  return kind.si == "m" ? 0.05 : 0.02;
}

bool is_astray(const MonteCarloTrial& trial, const Estimate& estimate) {
  if (!estimate.failure.empty() || estimate.error.size() == 0) return false;
  for (std::size_t k = 0; k < trial.parameters.size(); ++k) {
    if (std::abs(estimate.error[static_cast<Eigen::Index>(k)]) > astray(kind_of(trial.parameters[k]))) {
      return true;
    }
  }
  return false;
}

bool counts(const MonteCarloTrial& trial, const Estimate& estimate) {
  return estimate.failure.empty() && estimate.error.size() > 0 && !is_astray(trial, estimate);
}

/// Calls visit(trial, index) for each parameter of a kind.
template <class Visit>
void for_each_of(const ParameterKind& kind, const std::vector<MonteCarloTrial>& trials, Visit visit) {
  for (const MonteCarloTrial& trial : trials) {
    for (std::size_t k = 0; k < trial.parameters.size(); ++k) {
      if (&kind_of(trial.parameters[k]) == &kind) visit(trial, static_cast<Eigen::Index>(k));
    }
  }
}

/// @param estimate_of  what one estimator made of a trial
template <class EstimateOf>
Scatter scatter_of(const ParameterKind& kind, const std::vector<MonteCarloTrial>& trials,
                   EstimateOf estimate_of) {
  std::vector<double> errors;
  double squares_estimated = 0;
  std::size_t one = 0;
  std::size_t two = 0;
  for_each_of(kind, trials, [&](const MonteCarloTrial& trial, Eigen::Index k) {
    const Estimate& estimate = estimate_of(trial);
    if (!counts(trial, estimate)) return;
    errors.push_back(estimate.error[k] / kind.in_si);
    if (estimate.std_error.size() == 0) return;
    squares_estimated += std::pow(estimate.std_error[k] / kind.in_si, 2);
    const double z = std::abs(estimate.error[k]) / estimate.std_error[k];
    one += z < 1 ? 1 : 0;
    two += z < 1.96 ? 1 : 0;
  });
  Scatter scatter;
  if (errors.empty()) return scatter;
  scatter.estimates = errors.size();
  const auto n = static_cast<double>(errors.size());
  for (const double error : errors) scatter.mean += error / n;
  double squares = 0;
  for (const double error : errors) squares += std::pow(error - scatter.mean, 2);
  scatter.std_dev = std::sqrt(squares / std::max(1.0, n - 1));
  scatter.estimated = std::sqrt(squares_estimated / n);
  scatter.one = static_cast<double>(one) / n;
  scatter.two = static_cast<double>(two) / n;
  return scatter;
}

/// RMS over trials and lasers, in the kind's unit; NaN if there are none.
double mean_size(const ParameterKind& kind, const std::vector<MonteCarloTrial>& trials,
                 Eigen::VectorXd MonteCarloTrial::*values) {
  double squares = 0;
  double n = 0;
  for_each_of(kind, trials, [&](const MonteCarloTrial& trial, Eigen::Index k) {
    squares += std::pow((trial.*values)[k] / kind.in_si, 2);
    n += 1;
  });
  return std::sqrt(squares / n);
}

bool ran_rqe(const std::vector<MonteCarloTrial>& trials) {
  return std::ranges::any_of(trials, [](const MonteCarloTrial& trial) { return trial.rqe.has_value(); });
}

std::string cell(const std::optional<Scatter>& scatter) {
  return scatter ? fmt::format("{:>8.3f} ± {:<7.3f}", scatter->mean, scatter->std_dev)
                 : fmt::format("{:^18}", "no result");
}

/// Empty, and not 0, without successful runs.
std::string cell_of_runs(const Scatter& scatter) {
  return scatter.estimates > 0 ? cell(scatter) : fmt::format("{:^18}", "none");
}

std::string figure(double value, int width, int digits) {
  return std::isfinite(value) ? fmt::format("{:>{}.{}f}", value, width, digits)
                              : fmt::format("{:>{}}", "-", width);
}

/// A cell of CSV: empty where there is no number.
std::string csv_cell(const Eigen::VectorXd& values, Eigen::Index i) {
  if (i >= values.size() || !std::isfinite(values[i])) return {};
  return fmt::format("{:.6g}", values[i]);
}

/// The refinement's errors next to their bound.
std::string refined_figures(const ErrorRow& row) {
  const Scatter& refined = row.refined;
  std::string text = cell_of_runs(refined) + figure(row.bound, 8, 4) + "  ";
  if (refined.estimates > 0) {
    text += figure(refined.std_dev > 0 ? refined.mean / refined.std_dev : 0, 8, 2) + "  " +
            figure(refined.std_dev / row.bound, 8, 2) + "  " + figure(refined.estimated / row.bound, 10, 2) +
            fmt::format("  {:>5.1f} {:>4.1f} %", 100 * refined.one, 100 * refined.two);
  } else {
    text += fmt::format("{:>8}  {:>8}  {:>10}  {:>12}", "-", "-", "-", "-");
  }
  return text + "  " + figure(row.bound_with_steps, 10, 4) + "\n";
}

bool has_paper(const Table& table) {
  return std::ranges::any_of(table.rows, [](const ErrorRow& row) { return row.paper.has_value(); });
}

bool has_rqe(const Table& table) {
  return std::ranges::any_of(table.rows, [](const ErrorRow& row) { return row.rqe.has_value(); });
}

}  // namespace

bool reports_refinement(const Table& table) {
  return std::ranges::any_of(table.rows, [](const ErrorRow& row) { return row.refined.estimates > 0; });
}

Table table_of(const std::vector<MonteCarloTrial>& trials, bool papers) {
  const bool with_rqe = ran_rqe(trials);
  Table table{.runs = trials.size()};
  for (const ParameterKind& kind : parameter_kinds()) {
    const double bound = mean_size(kind, trials, &MonteCarloTrial::bound);
    if (std::isnan(bound)) continue;
    ErrorRow& row = table.rows.emplace_back(ErrorRow{
        .parameter = kind.name,
        .unit = kind.unit,
        .paper = papers ? in_the_paper(kind.name) : std::nullopt,
        .rqe = {},
        .refined =
            scatter_of(kind, trials, [](const MonteCarloTrial& t) -> const Estimate& { return t.refined; }),
        .bound = bound,
        .bound_with_steps = mean_size(kind, trials, &MonteCarloTrial::bound_with_steps)});
    if (with_rqe) {
      row.rqe = scatter_of(kind, trials, [](const MonteCarloTrial& t) -> const Estimate& { return *t.rqe; });
    }
  }
  for (const MonteCarloTrial& trial : trials) {
    const bool failed = !trial.refined.failure.empty();
    table.refined_failed += failed ? 1 : 0;
    table.rqe_astray += trial.rqe && is_astray(trial, *trial.rqe) ? 1 : 0;
    table.refined_astray += !failed && is_astray(trial, trial.refined) ? 1 : 0;
  }
  return table;
}

std::string table_text(const Table& table) {
  const bool paper = has_paper(table);
  const bool rqe = has_rqe(table);
  std::string text = fmt::format("{:<16}", "error, mean ± sd");
  if (paper) text += fmt::format("{:^18}  ", "paper, Table 1");
  if (rqe) text += fmt::format("{:^18}  ", "RQE");
  text += fmt::format("{:^18}{:>8}  {:>8}  {:>8}  {:>10}  {:>12}  {:>10}\n", "refined", "bound", "mean/sd",
                      "sd/bound", "s.e./bound", "in 1, 2 s.e.", "with steps");
  for (const ErrorRow& row : table.rows) {
    text += fmt::format("{:<7}{:<9}", row.parameter, row.unit);
    if (paper) text += cell(row.paper) + "  ";
    if (rqe) text += cell_of_runs(row.rqe.value_or(Scatter{})) + "  ";
    text += refined_figures(row);
  }
  text += fmt::format("{} runs; ended in another local minimum and left out: ", table.runs);
  if (rqe) text += fmt::format("{} (RQE), ", table.rqe_astray);
  text += fmt::format("{} (refined)", table.refined_astray);
  if (table.refined_failed > 0) text += fmt::format("; not refined: {}", table.refined_failed);
  return text;
}

std::string runs_csv(const std::vector<MonteCarloTrial>& trials) {
  std::string text = "seed,parameter,unit,bound,bound_with_steps,rqe_error,error,std_error,failure\n";
  for (const MonteCarloTrial& trial : trials) {
    const Estimate& refined = trial.refined;
    for (std::size_t k = 0; k < trial.parameters.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      const std::string& parameter = trial.parameters[k];
      text += fmt::format("{},{},{},{},{},{},", trial.seed, parameter, kind_of(parameter).si,
                          csv_cell(trial.bound, i), csv_cell(trial.bound_with_steps, i),
                          trial.rqe ? csv_cell(trial.rqe->error, i) : "");
      if (refined.failure.empty()) {
        text += fmt::format("{},{},\n", csv_cell(refined.error, i), csv_cell(refined.std_error, i));
      } else {
        text += fmt::format(",,\"{}\"\n", refined.failure);
      }
    }
  }
  return text;
}

}  // namespace crisp::study
