// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/study/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pipeline/data/degree.hpp"
#include "plugins/study/parameter_kind.hpp"

namespace crisp {
namespace {

/// Table 1 of the paper.
std::optional<Scatter> in_the_paper(const std::string& name) {
  if (name == "tau") return Scatter{.mean = 2.1, .std_dev = 0.6};
  if (name == "alpha") return Scatter{.mean = 0.06, .std_dev = 0.12};
  return {};
}

/// [SI] Errors beyond are of another valley.
double astray(const ParameterKind& kind) {
  if (kind.si == "rad") return 5 * kDegree;
  return kind.si == "m" ? 0.05 : 0.02;
}

bool is_astray(const Trial& trial, const Estimate& estimate) {
  for (std::size_t k = 0; k < trial.parameters.size(); ++k) {
    if (std::abs(estimate.error[static_cast<Eigen::Index>(k)]) > astray(kind_of(trial.parameters[k]))) {
      return true;
    }
  }
  return false;
}

bool counts(const Trial& trial, const Estimate& estimate) {
  return estimate.failure.empty() && !is_astray(trial, estimate);
}

/// Calls visit(trial, index) for each parameter of a kind.
template <class Visit>
void for_each_of(const ParameterKind& kind, const std::vector<Trial>& trials, Visit visit) {
  for (const Trial& trial : trials) {
    for (std::size_t k = 0; k < trial.parameters.size(); ++k) {
      if (&kind_of(trial.parameters[k]) == &kind) visit(trial, static_cast<Eigen::Index>(k));
    }
  }
}

Scatter scatter_of(const ParameterKind& kind, const std::vector<Trial>& trials, Estimate Trial::*which) {
  std::vector<double> errors;
  std::size_t one = 0;
  std::size_t two = 0;
  for_each_of(kind, trials, [&](const Trial& trial, Eigen::Index k) {
    const Estimate& estimate = trial.*which;
    if (!counts(trial, estimate)) return;
    errors.push_back(estimate.error[k] / kind.in_si);
    if (estimate.std_error.size() == 0) return;
    const double z = std::abs(estimate.error[k]) / estimate.std_error[k];
    one += z < 1 ? 1 : 0;
    two += z < 1.96 ? 1 : 0;
  });
  Scatter scatter;
  if (errors.empty()) return scatter;
  const auto n = static_cast<double>(errors.size());
  for (const double error : errors) scatter.mean += error / n;
  double squares = 0;
  for (const double error : errors) squares += std::pow(error - scatter.mean, 2);
  scatter.std_dev = std::sqrt(squares / std::max(1.0, n - 1));
  scatter.one = static_cast<double>(one) / n;
  scatter.two = static_cast<double>(two) / n;
  return scatter;
}

std::string cell(const Scatter& scatter) {
  return fmt::format("{:>8.3f} ± {:<7.3f}", scatter.mean, scatter.std_dev);
}

}  // namespace

Table table_of(const std::vector<Trial>& trials) {
  Table table{.runs = trials.size()};
  for (const ParameterKind& kind : parameter_kinds()) {
    double squares = 0;
    double n = 0;
    for_each_of(kind, trials, [&](const Trial& trial, Eigen::Index k) {
      squares += std::pow(trial.bound[k] / kind.in_si, 2);
      n += 1;
    });
    if (n == 0) continue;
    table.rows.push_back({.parameter = kind.name,
                          .unit = kind.unit,
                          .paper = in_the_paper(kind.name),
                          .rqe = scatter_of(kind, trials, &Trial::rqe),
                          .refined = scatter_of(kind, trials, &Trial::refined),
                          .bound = std::sqrt(squares / n)});
  }
  for (const Trial& trial : trials) {
    const bool failed = !trial.refined.failure.empty();
    table.refined_failed += failed ? 1 : 0;
    table.rqe_astray += is_astray(trial, trial.rqe) ? 1 : 0;
    table.refined_astray += !failed && is_astray(trial, trial.refined) ? 1 : 0;
  }
  return table;
}

std::string table_text(const Table& table) {
  std::string text = fmt::format("{:<14}{:^18}  {:^18}  {:^18}{:>8}  {:>9}  {:>11}\n", "error, mean ± sd",
                                 "paper, Table 1", "RQE", "refined", "bound", "sd/bound", "in 1, 2 s.e.");
  for (const TableRow& row : table.rows) {
    text +=
        fmt::format("{:<7}{:<9}{:^18}  {}  {}{:>8.3f}  {:>9.2f}  {:>5.1f} {:>4.1f} %\n", row.parameter,
                    row.unit, row.paper ? cell(*row.paper) : "not told", cell(row.rqe), cell(row.refined),
                    row.bound, row.refined.std_dev / row.bound, 100 * row.refined.one, 100 * row.refined.two);
  }
  text += fmt::format("{} runs; ended in another valley and left out: {} (RQE), {} (refined)", table.runs,
                      table.rqe_astray, table.refined_astray);
  if (table.refined_failed > 0) text += fmt::format("; not refined: {}", table.refined_failed);
  return text;
}

std::string runs_csv(const std::vector<Trial>& trials) {
  std::string text = "seed,parameter,unit,bound,rqe_error,error,std_error,failure\n";
  for (const Trial& trial : trials) {
    const Estimate& refined = trial.refined;
    for (std::size_t k = 0; k < trial.parameters.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      const std::string& parameter = trial.parameters[k];
      text += fmt::format("{},{},{},{:.6g},{:.6g},", trial.seed, parameter, kind_of(parameter).si,
                          trial.bound[i], trial.rqe.error[i]);
      if (refined.failure.empty()) {
        text += fmt::format("{:.6g},{:.6g},\n", refined.error[i], refined.std_error[i]);
      } else {
        text += fmt::format(",,\"{}\"\n", refined.failure);
      }
    }
  }
  return text;
}

}  // namespace crisp
