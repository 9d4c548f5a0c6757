// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/scans/mounting.hpp"

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <map>

#include "pipeline/statistics/bootstrap.hpp"
#include "pipeline/statistics/robust_estimators.hpp"

namespace crisp::diagnose {
namespace {

constexpr Eigen::Index kGlobal = kMountingParameters;
constexpr int kSteps = 12;
using GlobalMatrix = Eigen::Matrix<double, kGlobal, kGlobal>;
using GlobalVector = Eigen::Matrix<double, kGlobal, 1>;

Eigen::Vector3d away_from_axis(double angle) { return {std::cos(angle), std::sin(angle), 0}; }
Eigen::Vector3d along_normal(double angle) { return {-std::sin(angle), std::cos(angle), 0}; }

/// Direction of equation (2) for a scan plane that contains the axis.
Eigen::Vector3d direction_of(const FlatWindow::Sight& sight) {
  return std::sin(sight.mirror) * away_from_axis(sight.angle) -
         std::cos(sight.mirror) * Eigen::Vector3d::UnitZ();
}

Eigen::Vector3d centre_of(const FlatWindow::Sight& sight, const MountingValues& values) {
  return values[kAlongBeam] * away_from_axis(sight.angle) + values[kAlongNormal] * along_normal(sight.angle);
}

/// A local parametrization of a plane: (normal + a u + b v) · (x − middle) = shift. Ranges are nearly linear
/// in shift, a and b, wherever the plane lies.
struct LocalPlane {
  Eigen::Vector3d middle;
  Eigen::Matrix3d axes;                                  ///< columns: normal, u and v
  Eigen::Vector3d parameters = Eigen::Vector3d::Zero();  ///< shift [m], a, b

  Eigen::Vector3d normal() const {
    return axes.col(0) + parameters(1) * axes.col(1) + parameters(2) * axes.col(2);
  }
};

/// Predicted range of one beam on a plane, with its derivatives.
struct Predicted {
  double range = 0;
  Eigen::Vector3d by_plane;
  GlobalVector by_mounting;
};

Predicted predict(const FlatWindow::Sight& sight, const LocalPlane& plane, const MountingValues& values) {
  const Eigen::Vector3d direction = direction_of(sight);
  const Eigen::Vector3d from_middle = centre_of(sight, values) - plane.middle;
  const Eigen::Vector3d normal = plane.normal();
  const double slope = normal.dot(direction);
  const double true_range = (plane.parameters(0) - normal.dot(from_middle)) / slope;
  const Eigen::Vector3d met = from_middle + true_range * direction;
  Predicted beam;
  beam.range = true_range - values[kRangeOffset];
  beam.by_plane << 1 / slope, -plane.axes.col(1).dot(met) / slope, -plane.axes.col(2).dot(met) / slope;
  beam.by_mounting << -normal.dot(away_from_axis(sight.angle)) / slope,
      -normal.dot(along_normal(sight.angle)) / slope, -1;
  return beam;
}

/// Normal equations of a window after eliminating its plane (Schur complement).
struct Projected {
  GlobalMatrix matrix = GlobalMatrix::Zero();
  GlobalVector gradient = GlobalVector::Zero();
  Eigen::Vector3d plane_step = Eigen::Vector3d::Zero();  ///< for unchanged mounting
  double squares = 0;                                    ///< [m²] before the step
};

Projected project(const FlatWindow& window, const LocalPlane& plane, const MountingValues& values,
                  const GlobalVector& free) {
  Eigen::Matrix3d planes = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 3, kGlobal> mixed = Eigen::Matrix<double, 3, kGlobal>::Zero();
  Eigen::Vector3d of_plane = Eigen::Vector3d::Zero();
  Projected all;
  for (const auto& sight : window.sights) {
    Predicted beam = predict(sight, plane, values);
    beam.by_mounting = beam.by_mounting.cwiseProduct(free);
    const double error = sight.range - beam.range;
    planes += beam.by_plane * beam.by_plane.transpose();
    mixed += beam.by_plane * beam.by_mounting.transpose();
    of_plane += beam.by_plane * error;
    all.matrix += beam.by_mounting * beam.by_mounting.transpose();
    all.gradient += beam.by_mounting * error;
    all.squares += error * error;
  }
  const auto solver = planes.ldlt();
  all.plane_step = solver.solve(of_plane);
  const Eigen::Matrix<double, 3, kGlobal> through = solver.solve(mixed);
  all.matrix -= mixed.transpose() * through;
  all.gradient -= through.transpose() * of_plane;
  return all;
}

/// Plane of a window by total least squares of its points.
LocalPlane first_plane(const FlatWindow& window, const MountingValues& values) {
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& sight : window.sights) {
    const Eigen::Vector3d point =
        centre_of(sight, values) + (sight.range + values[kRangeOffset]) * direction_of(sight);
    squares += point * point.transpose();
    sum += point;
  }
  const auto count = static_cast<double>(window.sights.size());
  const Eigen::Vector3d middle = sum / count;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> across(squares / count - middle * middle.transpose());
  return {.middle = middle, .axes = across.eigenvectors()};  // ascending eigenvalues: the normal comes first
}

GlobalVector mask_of(const std::vector<MountingParameter>& free) {
  GlobalVector mask = GlobalVector::Zero();
  for (const auto parameter : free) mask(parameter) = 1;
  return mask;
}

constexpr std::array<double, kMountingParameters> kKnownBefore = {0.3, 0.3, 0.1};  // [m] prior σ
constexpr double kRangeNoise = 0.01;                                               // [m]

double weight_before(std::size_t parameter) {
  return kRangeNoise * kRangeNoise / (kKnownBefore[parameter] * kKnownBefore[parameter]);
}

/// Gauss-Newton step of the free parameters with a normal prior.
GlobalVector solve_free(GlobalMatrix matrix, GlobalVector gradient, const GlobalVector& free,
                        const MountingValues& values) {
  for (Eigen::Index i = 0; i < kGlobal; ++i) {
    const auto k = static_cast<std::size_t>(i);
    matrix(i, i) += free(i) == 0 ? 1 : weight_before(k);
    gradient(i) -= free(i) == 0 ? gradient(i) : weight_before(k) * values[k];
  }
  return matrix.ldlt().solve(gradient);
}

MountingValues moved(MountingValues values, const GlobalVector& step, double share) {
  for (std::size_t k = 0; k < kMountingParameters; ++k)
    values[k] += share * step(static_cast<Eigen::Index>(k));
  return values;
}

/// Plane of a window by least squares in the ranges, for a given mounting (damped Gauss-Newton).
LocalPlane best_plane(const FlatWindow& window, const MountingValues& values) {
  constexpr int kRounds = 10;
  constexpr double kMinShare = 1.0 / 64;
  constexpr double kSettled = 1e-9;  // relative decrease of the squares
  LocalPlane plane = first_plane(window, values);
  Projected now = project(window, plane, values, GlobalVector::Zero());
  for (int i = 0; i < kRounds; ++i) {
    bool better = false;
    const double before = now.squares;
    const Eigen::Vector3d from = plane.parameters;
    const Eigen::Vector3d step = now.plane_step;
    for (double share = 1; share > kMinShare && !better; share /= 2) {
      LocalPlane next_plane = plane;
      next_plane.parameters = from + share * step;
      Projected next = project(window, next_plane, values, GlobalVector::Zero());
      better = next.squares < now.squares;
      if (!better) continue;
      plane = next_plane;
      now = next;
    }
    if (!better || now.squares > (1 - kSettled) * before) break;
  }
  return plane;
}

/// Sum of squares of all windows at one mounting.
struct AtMounting {
  std::vector<Projected> parts;
  double squares = 0;  ///< [m²]
  double cost = 0;     ///< [m²] including the prior
};

AtMounting at_mounting(const std::vector<FlatWindow>& windows, const MountingValues& values,
                       const GlobalVector& free) {
  AtMounting all;
  for (const auto& window : windows) {
    all.parts.push_back(project(window, best_plane(window, values), values, free));
    all.squares += all.parts.back().squares;
  }
  all.cost = all.squares;
  for (std::size_t k = 0; k < kMountingParameters; ++k) {
    if (free(static_cast<Eigen::Index>(k)) > 0) all.cost += weight_before(k) * values[k] * values[k];
  }
  return all;
}

/// [m] Range noise from second differences of each beam over three scans (median). Some lasers smooth over
/// beams, so differences between neighbouring beams would be too small.
double noise_between_scans(const FlatWindow& window) {
  std::map<std::size_t, std::pair<double, double>> before;  // last two ranges by beam
  std::map<std::size_t, int> seen;
  std::vector<double> second;
  for (const auto& sight : window.sights) {
    auto& [last, but_one] = before[sight.beam];
    if (++seen[sight.beam] > 2) second.push_back(std::abs(but_one - 2 * last + sight.range));
    but_one = last;
    last = sight.range;
  }
  constexpr double kSecond = 2.449489742783178;  // √6
  return statistics::median_in_place(second) * statistics::kMadToSigma / kSecond;
}

/// Whether the window is flat, with an optical centre of its own.
bool is_flat(const FlatWindow& window) {
  constexpr std::size_t kMin = 60;
  constexpr double kOfNoise = 3, kMinNoise = 0.002;
  if (window.sights.size() < kMin) return false;
  const double noise = std::max(noise_between_scans(window), kMinNoise);
  const GlobalVector free = mask_of({kAlongBeam, kAlongNormal});
  MountingValues values{};
  Projected own = project(window, best_plane(window, values), values, free);
  const MountingValues other = moved(values, solve_free(own.matrix, own.gradient, free, values), 1);
  const double squares =
      std::min(own.squares, project(window, best_plane(window, other), other, free).squares);
  const double rms = std::sqrt(squares / static_cast<double>(window.sights.size()));
  return std::isfinite(rms) && rms < kOfNoise * noise;
}

/// Systematic subsample of many sights: no real surface passes a flatness test of thousands.
void thin(FlatWindow& window) {
  constexpr std::size_t kEnough = 600;
  const std::size_t every = 1 + window.sights.size() / kEnough;
  std::vector<FlatWindow::Sight> some;
  for (std::size_t i = 0; i < window.sights.size(); i += every) some.push_back(window.sights[i]);
  window.sights = std::move(some);
}

}  // namespace

std::vector<FlatWindow> flat_windows(const Pass& pass, const FanGeometry& fan, double side) {
  std::vector<FlatWindow> windows;
  if (pass.scans.size() < 2 || fan.step == 0) return windows;
  const double first_angle = pass.scans.front().angle;
  const auto beams_across = static_cast<std::size_t>(std::max(1.0, side / std::abs(fan.step)));
  const std::size_t beams = pass.scans.front().ranges->size();
  for (std::size_t begin = 0; begin < pass.scans.size();) {
    const double limit =
        first_angle + side * (1 + std::floor((pass.scans[begin].angle - first_angle) / side));
    std::size_t end = begin + 1;
    while (end < pass.scans.size() && pass.scans[end].angle < limit) ++end;
    for (std::size_t k0 = 0; k0 + beams_across <= beams; k0 += beams_across) {
      FlatWindow window;
      for (std::size_t i = begin; i < end; ++i) {
        const auto& ranges = *pass.scans[i].ranges;
        for (std::size_t k = k0; k < std::min(k0 + beams_across, ranges.size()); ++k) {
          if (!(ranges[k] > 0)) continue;
          window.sights.push_back({.angle = pass.scans[i].angle,
                                   .mirror = fan.first + static_cast<double>(k) * fan.step,
                                   .range = static_cast<double>(ranges[k]),
                                   .beam = k});
        }
      }
      const bool whole = 10 * window.sights.size() >= 9 * (end - begin) * beams_across;
      if (!whole || !is_flat(window)) continue;
      thin(window);
      windows.push_back(std::move(window));
    }
    begin = end;
  }
  return windows;
}

MountingFit fit_mounting(const std::vector<FlatWindow>& windows, const MountingValues& start,
                         const std::vector<MountingParameter>& free, std::uint64_t seed) {
  MountingFit fit{.values = start, .windows = windows.size()};
  if (windows.empty()) return fit;
  const GlobalVector mask = mask_of(free);
  for (const auto& window : windows) fit.beams += window.sights.size();
  AtMounting now = at_mounting(windows, fit.values, mask);
  const auto step_of = [&](const std::vector<std::size_t>& picked) {
    GlobalMatrix matrix = GlobalMatrix::Zero();
    GlobalVector gradient = GlobalVector::Zero();
    for (const auto w : picked) {
      matrix += now.parts[w].matrix;
      gradient += now.parts[w].gradient;
    }
    return solve_free(matrix, gradient, mask, fit.values);
  };
  std::vector<std::size_t> all(windows.size());
  for (std::size_t w = 0; w < all.size(); ++w) all[w] = w;
  for (int i = 0; i < kSteps; ++i) {
    const GlobalVector step = step_of(all);
    constexpr double kSmall = 1e-5;  // [m]
    bool better = false;
    for (double share = 1; share > 1.0 / 64 && !better; share /= 2) {
      const MountingValues values = moved(fit.values, step, share);
      AtMounting next = at_mounting(windows, values, mask);
      better = next.cost < now.cost;
      if (!better) continue;
      fit.values = values;
      now = std::move(next);
    }
    if (!better || step.norm() < kSmall) break;
  }
  fit.rms = std::sqrt(now.squares / static_cast<double>(fit.beams));
  constexpr std::size_t kDrawsOfWindows = 300;
  for (const auto parameter : free) {
    fit.std_errors[parameter] =
        statistics::bootstrap(windows.size(), 1, seed, kDrawsOfWindows, [&](const auto& picked) {
          return step_of(picked)(parameter);
        }).std_error;
  }
  return fit;
}

std::vector<FlatWindow> with_injected(const std::vector<FlatWindow>& windows, MountingParameter parameter,
                                      double by) {
  std::vector<FlatWindow> changed = windows;
  for (auto& window : changed) {
    const MountingValues none{};
    const LocalPlane plane = best_plane(window, none);
    for (auto& sight : window.sights) sight.range += by * predict(sight, plane, none).by_mounting(parameter);
  }
  return changed;
}

}  // namespace crisp::diagnose
