// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/noise/common_mode_range_error.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "pipeline/clocks/series.hpp"
#include "pipeline/statistics/dense_solvers.hpp"
#include "plugins/diagnose/noise/permutation_test.hpp"

namespace crisp::diagnose {
namespace {

constexpr std::array kWarmUps = {0.03, 0.1, 0.3,
                                 1.0};  // time constants, relative to the recording's duration
constexpr Eigen::Index kMargin = 4;     // scans at either end, where no step is tested

/// Mean error of each scan, weighted by the inverse variance of each beam: a beam that meets moving objects
/// has a low weight.
Eigen::VectorXd means(const RangeErrors& errors, std::size_t scans) {
  std::vector<double> squares(beams_of(errors), 0);
  std::vector<double> shots(squares.size(), 0);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    squares[errors.beam[i]] += std::pow(double{errors.value[i]}, 2);
    shots[errors.beam[i]] += 1;
  }
  constexpr double kMin = 1e-6;  // [m²] square of a device's resolution, a millimetre
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(scans));
  Eigen::VectorXd weights = sums;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const std::size_t beam = errors.beam[i];
    const double weight = 1 / std::max(kMin, squares[beam] / shots[beam]);
    sums[errors.block[i]] += weight * double{errors.value[i]};
    weights[errors.block[i]] += weight;
  }
  return sums.cwiseQuotient(weights.cwiseMax(std::numeric_limits<double>::min()));
}

/// Regressors of a wander: a constant and cosines, n × (1 + count).
Eigen::MatrixXd slow(const Eigen::ArrayXd& time, Eigen::Index count) {
  Eigen::MatrixXd columns(time.size(), count + 1);
  for (Eigen::Index k = 0; k <= count; ++k) {
    columns.col(k) = (std::numbers::pi * static_cast<double>(k) / time[time.size() - 1] * time).cos();
  }
  return columns;
}

/// [s] The catalogue and the simulator have no shorter time constants.
double time_constant(std::size_t warm_up, double duration) {
  constexpr double kMin = 0.5;
  return std::max(kMin, kWarmUps.at(warm_up) * duration);
}

Eigen::MatrixXd creeping(const Eigen::ArrayXd& time) {
  Eigen::MatrixXd columns(time.size(), static_cast<Eigen::Index>(kWarmUps.size()));
  for (std::size_t k = 0; k < kWarmUps.size(); ++k) {
    const double constant = time_constant(k, time[time.size() - 1]);
    columns.col(static_cast<Eigen::Index>(k)) = 1 - (-time / constant).exp();
  }
  return columns;
}

/// Regressors of the changes with a known cause, one per column.
struct Shapes {
  Eigen::MatrixXd jumps, creeping;
};

/// One model of the scans' means, with its BIC.
struct MeansModel {
  Eigen::MatrixXd base;                      // constant, and cosines of a wander
  const Eigen::MatrixXd* columns = nullptr;  // candidates for the change with a known cause
  bool is_step = true;
  double bic = 0;

  bool has_change() const { return columns != nullptr; }
  bool is_nothing() const { return !has_change() && base.cols() == 1; }
};

MeansModel with_bic(Eigen::MatrixXd base, const Eigen::MatrixXd* columns, bool is_step,
                    const Eigen::VectorXd& values) {
  constexpr double kOfItsOwn = 2;  // parameters of a change: size and shape
  auto parameters = static_cast<double>(base.cols());
  double squares = clocks::off_base(base, values).squaredNorm();
  if (columns != nullptr) {
    squares -= std::pow(clocks::best_in_series(base, *columns, values).product, 2);
    parameters += kOfItsOwn;
  }
  return {std::move(base), columns, is_step, bic_of_series(squares, values.size(), parameters)};
}

std::vector<MeansModel> means_models(const Eigen::ArrayXd& time, const Shapes& shapes,
                                     const Eigen::VectorXd& values) {
  const Eigen::MatrixXd still = slow(time, 0);
  std::vector<MeansModel> all = {with_bic(still, nullptr, true, values),
                                 with_bic(still, &shapes.jumps, true, values),
                                 with_bic(still, &shapes.creeping, false, values)};
  for (const Eigen::Index count : {2, 4, 8}) {
    all.push_back(with_bic(slow(time, count), nullptr, true, values));
    all.push_back(with_bic(slow(time, count), &shapes.jumps, true, values));
  }
  return all;
}

/// Permutation test of the cosines, given the other regressors.
double p_of_wander(const Eigen::MatrixXd& rest, const Eigen::MatrixXd& cosines,
                   const Eigen::VectorXd& values) {
  const Eigen::MatrixXd given_rest = clocks::off_base(rest, cosines);
  const Eigen::VectorXd without = clocks::off_base(rest, values);
  const double left = clocks::off_base(given_rest, without).squaredNorm();
  const auto own = static_cast<double>(cosines.cols());
  const auto degrees_of_freedom = static_cast<double>(values.size() - rest.cols() - cosines.cols());
  if (!(left > 0)) return 1;
  const double ratio = (without.squaredNorm() - left) / own / (left / degrees_of_freedom);
  return boost::math::cdf(
      boost::math::complement(boost::math::fisher_f(own, degrees_of_freedom), std::max(0.0, ratio)));
}

Gain named(Gain gain) {
  gain.metric = "mean error of a scan";
  gain.unit = "m";
  return gain;
}

/// @param next_likely  BIC of the best model without such a change
CommonModeChange change_of(const MeansModel& model, const PermutationTest& test,
                           const std::vector<double>& seconds, double next_likely, double tests) {
  const auto own = test.values.size() - 1;
  CommonModeChange change{.is_step = model.is_step,
                          .size = test.values[own],
                          .std_error = test.errors[own],
                          .p_value = std::min(1.0, test.p_value * tests),
                          .log10_bayes_factor = (next_likely - model.bic) / 2 / std::numbers::ln10,
                          .gain = named(test.gain)};
  if (model.is_step) {
    const auto first = static_cast<std::size_t>(clocks::before_step(model.columns->col(test.column)));
    change.shape = seconds[first];
    // Scans may arrive in bursts, at equal receipt times: the mean interval is the resolution of a step.
    const double between = (seconds.back() - seconds.front()) / static_cast<double>(seconds.size() - 1);
    change.shape_error = std::max(between, seconds[first] - seconds[first - 1]);
  } else {
    change.shape = time_constant(static_cast<std::size_t>(test.column), seconds.back() - seconds.front());
    change.shape_error = change.shape;  // order of magnitude only
  }
  return change;
}

CommonModeWander wander_of(const Eigen::MatrixXd& cosines, const Eigen::MatrixXd& rest,
                           const Eigen::VectorXd& values, double tests, std::uint64_t seed) {
  Eigen::MatrixXd design(values.size(), cosines.cols() + rest.cols());
  design << cosines, rest;
  const Eigen::VectorXd fit = statistics::least_squares(design, values);
  const Eigen::ArrayXd wander = cosines * fit.head(cosines.cols());
  return {.rms = std::sqrt((wander - wander.mean()).square().mean()),
          .p_value = std::min(1.0, tests * p_of_wander(rest, cosines, values)),
          .gain = named(gain_in_series(rest, cosines, values, seed))};
}

/// The model of smallest BIC, among all or among those without a change of known cause.
const MeansModel& lowest_bic(const std::vector<MeansModel>& all, bool with_cause) {
  const auto price = [&](const MeansModel& model) {
    return with_cause || !model.has_change() ? model.bic : std::numeric_limits<double>::infinity();
  };
  return *std::ranges::min_element(all, {}, price);
}

double lowest_bic_without(const std::vector<MeansModel>& all, const MeansModel& model) {
  double least = std::numeric_limits<double>::infinity();
  for (const MeansModel& other : all) {
    if (!other.has_change() || other.is_step != model.is_step) least = std::min(least, other.bic);
  }
  return least;
}

/// Fits one model to the scans' means.
CommonModeError fit_model(const MeansModel& model, double next_likely, const Eigen::VectorXd& values,
                          const std::vector<double>& seconds, double tests, std::uint64_t seed) {
  CommonModeError found;
  Eigen::MatrixXd rest = model.base.leftCols(1);
  if (model.has_change()) {
    const PermutationTest test = test_series(model.base, *model.columns, values, seed);
    found.change = change_of(model, test, seconds, next_likely, tests);
    rest.conservativeResize(Eigen::NoChange, 2);
    rest.col(1) = model.columns->col(test.column);
    found.named = found.change->size * (rest.col(1).array() - rest.col(1).mean());
  }
  Eigen::MatrixXd design = rest;
  if (model.base.cols() > 1) {
    const Eigen::MatrixXd cosines = model.base.rightCols(model.base.cols() - 1);
    found.wander = wander_of(cosines, rest, values, tests, seed);
    design.conservativeResize(Eigen::NoChange, rest.cols() + cosines.cols());
    design.rightCols(cosines.cols()) = cosines;
  }
  found.curve = values - clocks::off_base(design, values);
  found.curve.array() -= found.curve.mean();
  return found;
}

/// Whether all parts are significant. The residual of a wander that cosines do not span may resemble a small
/// step.
bool is_significant(const CommonModeError& found) {
  constexpr double kAboveWander = 3;
  if (found.wander && found.wander->p_value > kSignificantInSeries) return false;
  if (!found.change) return true;
  if (found.change->p_value > kSignificantInSeries) return false;
  return !found.wander || std::abs(found.change->size) > kAboveWander * found.wander->rms;
}

}  // namespace

CommonModeError common_mode_error(const RangeErrors& errors, const std::vector<double>& seconds,
                                  std::size_t tests, std::uint64_t seed) {
  const auto n = static_cast<Eigen::Index>(seconds.size());
  constexpr Eigen::Index kMin = 32;
  if (n < kMin || !(seconds.back() > seconds.front())) return {};
  const Eigen::VectorXd values = means(errors, seconds.size());
  const Eigen::ArrayXd time = Eigen::Map<const Eigen::ArrayXd>(seconds.data(), n) - seconds.front();
  const Shapes shapes{.jumps = clocks::steps(n, kMargin), .creeping = creeping(time)};
  const auto all = means_models(time, shapes, values);
  for (const bool with_cause : {true, false}) {
    const MeansModel& model = lowest_bic(all, with_cause);
    if (model.is_nothing()) return {};
    CommonModeError found =
        fit_model(model, lowest_bic_without(all, model), values, seconds, static_cast<double>(tests), seed);
    if (is_significant(found)) return found;
  }
  return {};
}

plot::Plot common_plot(const std::string& name, const CommonModeError& found, const RangeErrors& errors,
                       const std::vector<double>& seconds) {
  const Eigen::VectorXd values = means(errors, seconds.size());
  plot::PlotSeries measured{.name = "measured", .x = {}, .y = {}, .joined = false};
  plot::PlotSeries curve{.name = "fitted", .x = {}, .y = {}};
  for (std::size_t scan = 0; scan < seconds.size(); ++scan) {
    const auto at = static_cast<Eigen::Index>(scan);
    measured.x.push_back(seconds[scan]);
    measured.y.push_back(1e3 * values[at]);
    curve.x.push_back(seconds[scan]);
    curve.y.push_back(1e3 * found.curve[at]);
  }
  return {.title = name + ": common-mode range error",
          .x_label = "time since the run's epoch [s]",
          .y_label = "mean error of a scan [mm]",
          .series = {std::move(measured), std::move(curve)}};
}

void subtract_curve(const Eigen::VectorXd& curve, RangeErrors& errors) {
  for (std::size_t i = 0; i < errors.size(); ++i) {
    errors.value[i] -= static_cast<float>(curve[errors.block[i]]);
  }
  errors.centre_beams();
}

}  // namespace crisp::diagnose
