// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/common_change.hpp"

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
#include "plugins/diagnose/series.hpp"

namespace crisp {
namespace {

constexpr std::array kWarmUps = {0.03, 0.1, 0.3, 1.0};  // time constants, as shares of the recording
constexpr Eigen::Index kMargin = 4;                     // scans

/// Mean error of each scan's beams, each weighted by its variance: one before which something moves counts
/// for little.
Eigen::VectorXd means(const RangeErrors& errors, std::size_t scans) {
  std::vector<double> squares(beams_of(errors), 0);
  std::vector<double> shots(squares.size(), 0);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    squares[errors.beam[i]] += std::pow(double{errors.value[i]}, 2);
    shots[errors.beam[i]] += 1;
  }
  constexpr double kLeast = 1e-6;  // [m²] of a millimetre, a device's step
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(scans));
  Eigen::VectorXd weights = sums;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const std::size_t beam = errors.beam[i];
    const double weight = 1 / std::max(kLeast, squares[beam] / shots[beam]);
    sums[errors.block[i]] += weight * double{errors.value[i]};
    weights[errors.block[i]] += weight;
  }
  return sums.cwiseQuotient(weights.cwiseMax(std::numeric_limits<double>::min()));
}

/// What is constant, then cosines: n × (1 + count).
Eigen::MatrixXd slow(const Eigen::ArrayXd& time, Eigen::Index count) {
  Eigen::MatrixXd columns(time.size(), count + 1);
  for (Eigen::Index k = 0; k <= count; ++k) {
    columns.col(k) = (std::numbers::pi * static_cast<double>(k) / time[time.size() - 1] * time).cos();
  }
  return columns;
}

/// [s] The catalogue, and so the simulator, has none that are shorter.
double time_constant(std::size_t warm_up, double duration) {
  constexpr double kLeast = 0.5;
  return std::max(kLeast, kWarmUps.at(warm_up) * duration);
}

Eigen::MatrixXd creeping(const Eigen::ArrayXd& time) {
  Eigen::MatrixXd columns(time.size(), static_cast<Eigen::Index>(kWarmUps.size()));
  for (std::size_t k = 0; k < kWarmUps.size(); ++k) {
    const double constant = time_constant(k, time[time.size() - 1]);
    columns.col(static_cast<Eigen::Index>(k)) = 1 - (-time / constant).exp();
  }
  return columns;
}

/// Changes that have names, a column each.
struct Shapes {
  Eigen::MatrixXd jumps, creeping;
};

/// One way in which the means may have changed, and its price.
struct Way {
  Eigen::MatrixXd base;                      // what is constant, and cosines if they wander
  const Eigen::MatrixXd* columns = nullptr;  // of which one is the change that has a name
  bool is_step = true;
  double bic = 0;

  bool has_change() const { return columns != nullptr; }
  bool is_nothing() const { return !has_change() && base.cols() == 1; }
};

Way priced(Eigen::MatrixXd base, const Eigen::MatrixXd* columns, bool is_step,
           const Eigen::VectorXd& values) {
  constexpr double kOfItsOwn = 2;  // its size and its shape
  auto parameters = static_cast<double>(base.cols());
  double squares = off_base(base, values).squaredNorm();
  if (columns != nullptr) {
    squares -= std::pow(best_in_series(base, *columns, values).product, 2);
    parameters += kOfItsOwn;
  }
  return {std::move(base), columns, is_step, bic_of_series(squares, values.size(), parameters)};
}

std::vector<Way> ways(const Eigen::ArrayXd& time, const Shapes& shapes, const Eigen::VectorXd& values) {
  const Eigen::MatrixXd still = slow(time, 0);
  std::vector<Way> all = {priced(still, nullptr, true, values), priced(still, &shapes.jumps, true, values),
                          priced(still, &shapes.creeping, false, values)};
  for (const Eigen::Index count : {2, 4, 8}) {
    all.push_back(priced(slow(time, count), nullptr, true, values));
    all.push_back(priced(slow(time, count), &shapes.jumps, true, values));
  }
  return all;
}

/// That noise alone makes cosines explain as much, beside what else changes.
double p_of_wander(const Eigen::MatrixXd& rest, const Eigen::MatrixXd& cosines,
                   const Eigen::VectorXd& values) {
  const Eigen::MatrixXd beside_rest = off_base(rest, cosines);
  const Eigen::VectorXd without = off_base(rest, values);
  const double left = off_base(beside_rest, without).squaredNorm();
  const auto own = static_cast<double>(cosines.cols());
  const auto freedom = static_cast<double>(values.size() - rest.cols() - cosines.cols());
  if (!(left > 0)) return 1;
  const double ratio = (without.squaredNorm() - left) / own / (left / freedom);
  return boost::math::cdf(boost::math::complement(boost::math::fisher_f(own, freedom), std::max(0.0, ratio)));
}

Gain named(Gain gain) {
  gain.metric = "mean error of a scan";
  gain.unit = "m";
  return gain;
}

/// @param next_likely  BIC of the best way without such a change
CommonChange change_of(const Way& way, const SeriesLook& look, const std::vector<double>& seconds,
                       double next_likely, double looks) {
  const auto own = look.values.size() - 1;
  CommonChange change{.is_step = way.is_step,
                      .size = look.values[own],
                      .std_error = look.errors[own],
                      .p_value = std::min(1.0, look.p_value * looks),
                      .log10_odds = (next_likely - way.bic) / 2 / std::numbers::ln10,
                      .gain = named(look.gain)};
  if (way.is_step) {
    const auto first = static_cast<std::size_t>(before_step(way.columns->col(look.column)));
    change.shape = seconds[first];
    // Of scans that come in bursts none is between two that came at once.
    const double between = (seconds.back() - seconds.front()) / static_cast<double>(seconds.size() - 1);
    change.shape_error = std::max(between, seconds[first] - seconds[first - 1]);
  } else {
    change.shape = time_constant(static_cast<std::size_t>(look.column), seconds.back() - seconds.front());
    change.shape_error = change.shape;  // known to a factor
  }
  return change;
}

CommonWander wander_of(const Eigen::MatrixXd& cosines, const Eigen::MatrixXd& rest,
                       const Eigen::VectorXd& values, double looks, std::uint64_t seed) {
  Eigen::MatrixXd design(values.size(), cosines.cols() + rest.cols());
  design << cosines, rest;
  const Eigen::VectorXd fit = least_squares(design, values);
  const Eigen::ArrayXd wander = cosines * fit.head(cosines.cols());
  return {.rms = std::sqrt((wander - wander.mean()).square().mean()),
          .p_value = std::min(1.0, looks * p_of_wander(rest, cosines, values)),
          .gain = named(gain_in_series(rest, cosines, values, seed))};
}

/// The cheapest of the ways, or of those in which nothing happens that has a name.
const Way& cheapest(const std::vector<Way>& all, bool with_a_name) {
  const auto price = [&](const Way& way) {
    return with_a_name || !way.has_change() ? way.bic : std::numeric_limits<double>::infinity();
  };
  return *std::ranges::min_element(all, {}, price);
}

double without_such(const std::vector<Way>& all, const Way& way) {
  double least = std::numeric_limits<double>::infinity();
  for (const Way& other : all) {
    if (!other.has_change() || other.is_step != way.is_step) least = std::min(least, other.bic);
  }
  return least;
}

/// What a way comes to in these means.
DoneTogether done_by(const Way& way, double next_likely, const Eigen::VectorXd& values,
                     const std::vector<double>& seconds, double looks, std::uint64_t seed) {
  DoneTogether found;
  Eigen::MatrixXd rest = way.base.leftCols(1);
  if (way.has_change()) {
    const SeriesLook look = look_at_series(way.base, *way.columns, values, seed);
    found.change = change_of(way, look, seconds, next_likely, looks);
    rest.conservativeResize(Eigen::NoChange, 2);
    rest.col(1) = way.columns->col(look.column);
    found.named = found.change->size * (rest.col(1).array() - rest.col(1).mean());
  }
  Eigen::MatrixXd design = rest;
  if (way.base.cols() > 1) {
    const Eigen::MatrixXd cosines = way.base.rightCols(way.base.cols() - 1);
    found.wander = wander_of(cosines, rest, values, looks, seed);
    design.conservativeResize(Eigen::NoChange, rest.cols() + cosines.cols());
    design.rightCols(cosines.cols()) = cosines;
  }
  found.curve = values - off_base(design, values);
  found.curve.array() -= found.curve.mean();
  return found;
}

/// Whether all of it is beyond chance. What a wander leaves that is not made of cosines may look like a small
/// step.
bool is_sure(const DoneTogether& found) {
  constexpr double kAboveWander = 3;
  if (found.wander && found.wander->p_value > kSignificantInSeries) return false;
  if (!found.change) return true;
  if (found.change->p_value > kSignificantInSeries) return false;
  return !found.wander || std::abs(found.change->size) > kAboveWander * found.wander->rms;
}

}  // namespace

DoneTogether done_together(const RangeErrors& errors, const std::vector<double>& seconds, std::size_t looks,
                           std::uint64_t seed) {
  const auto n = static_cast<Eigen::Index>(seconds.size());
  constexpr Eigen::Index kFewest = 32;
  if (n < kFewest || !(seconds.back() > seconds.front())) return {};
  const Eigen::VectorXd values = means(errors, seconds.size());
  const Eigen::ArrayXd time = Eigen::Map<const Eigen::ArrayXd>(seconds.data(), n) - seconds.front();
  const Shapes shapes{.jumps = steps(n, kMargin), .creeping = creeping(time)};
  const auto all = ways(time, shapes, values);
  for (const bool with_a_name : {true, false}) {
    const Way& way = cheapest(all, with_a_name);
    if (way.is_nothing()) return {};
    DoneTogether found =
        done_by(way, without_such(all, way), values, seconds, static_cast<double>(looks), seed);
    if (is_sure(found)) return found;
  }
  return {};
}

Plot common_plot(const std::string& name, const DoneTogether& found, const RangeErrors& errors,
                 const std::vector<double>& seconds) {
  const Eigen::VectorXd values = means(errors, seconds.size());
  PlotSeries measured{.name = "measured", .x = {}, .y = {}, .joined = false};
  PlotSeries curve{.name = "found", .x = {}, .y = {}};
  for (std::size_t scan = 0; scan < seconds.size(); ++scan) {
    const auto at = static_cast<Eigen::Index>(scan);
    measured.x.push_back(seconds[scan]);
    measured.y.push_back(1e3 * values[at]);
    curve.x.push_back(seconds[scan]);
    curve.y.push_back(1e3 * found.curve[at]);
  }
  return {.title = name + ": all beams together",
          .x_label = "time since the run's epoch [s]",
          .y_label = "mean error of a scan [mm]",
          .series = {std::move(measured), std::move(curve)}};
}

void take_out(const Eigen::VectorXd& curve, RangeErrors& errors) {
  for (std::size_t i = 0; i < errors.size(); ++i) {
    errors.value[i] -= static_cast<float>(curve[errors.block[i]]);
  }
  errors.centre_beams();
}

}  // namespace crisp
