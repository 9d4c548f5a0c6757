// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/quality/surfel_equations.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <random>

#include "pipeline/quality/encoder_nuisance.hpp"
#include "pipeline/quality/surfel_residuals.hpp"
#include "tests/pipeline/quality/room.hpp"

namespace crisp {
namespace {

using namespace crisp::quality;

constexpr std::size_t kParameters = 5;

/// How a room's points move with the shifts of the second and third laser (outwards, along), and with an
/// offset that all ranges share.
DerivativeRows derivatives_of(const test::RoomScan& scan) {
  return [&scan](const Surfel& surfel, std::span<const std::uint32_t> beams, std::span<const double>,
                 std::span<double> rows) {
    for (std::size_t k = 0; k < beams.size(); ++k) {
      const std::uint32_t i = beams[k];
      const Eigen::Vector3d& out = scan.outwards[i];
      double* row = &rows[k * kParameters];
      if (scan.laser[i] > 0) {
        double* own = row + 2 * (scan.laser[i] - 1);
        own[0] = surfel.normal.dot(out);
        own[1] = surfel.normal.dot(Eigen::Vector3d(-out.y(), out.x(), 0));
      }
      row[4] = surfel.normal.x() * scan.directions.x[i] + surfel.normal.y() * scan.directions.y[i] +
               surfel.normal.z() * scan.directions.z[i];
    }
  };
}

NormalEquations equations_of(const test::RoomScan& scan, const SurfelSettings& settings) {
  const auto surfels = find_surfels(scan.beams(), settings);
  return normal_equations(surfels, scan.beams(), kParameters, derivatives_of(scan), settings);
}

struct Estimate {
  Eigen::VectorXd value, std_error;
};

/// By how much the parameters are off, in one step.
Estimate estimate(const NormalEquations& equations) {
  const Eigen::MatrixXd inverse = equations.matrix.inverse();
  return {-inverse * equations.vector, (equations.covariance_factor() * inverse).diagonal().cwiseSqrt()};
}

TEST(SurfelEquations, AreThoseOfAllPlanesAndParametersTogether) {
  // One great least-squares problem, the planes among its unknowns, solved by QR: no Schur complement.
  const auto scan = test::scan_room(1500, {{0, 0}, {0.004, 0}, {0, 0.003}}, 0.012, 1);
  const SurfelSettings settings{.outlier = 0};
  const auto surfels = find_surfels(scan.beams(), settings);
  ASSERT_GT(surfels.surfels.size(), 6U);
  const auto equations = normal_equations(surfels, scan.beams(), kParameters, derivatives_of(scan), settings);

  std::vector<Eigen::VectorXd> rows;
  std::vector<double> right;
  const Eigen::Index unknowns = 5 + 3 * static_cast<Eigen::Index>(surfels.surfels.size());
  for (std::size_t s = 0; s < surfels.surfels.size(); ++s) {
    const Surfel& surfel = surfels.surfels[s];
    const auto residuals = residuals_of(surfel, surfels, scan.beams(), settings);
    for (std::uint32_t k = surfel.begin; k < surfel.end; ++k) {
      const SurfelResidual& r = residuals[k - surfel.begin];
      if (r.weight == 0) continue;
      Eigen::VectorXd row = Eigen::VectorXd::Zero(unknowns);
      std::vector<double> own(kParameters, 0);
      derivatives_of(scan)(surfel, std::span(&surfels.members[k], 1), std::span(&r.range_change, 1), own);
      row.head(5) = Eigen::Map<const Eigen::VectorXd>(own.data(), 5);
      row.segment<3>(5 + 3 * static_cast<Eigen::Index>(s)) = Eigen::Vector3d(1, r.u, r.v);
      rows.emplace_back(row / r.spread);
      right.push_back(-r.distance / r.spread);
    }
  }
  Eigen::MatrixXd design(static_cast<Eigen::Index>(rows.size()), unknowns);
  for (std::size_t i = 0; i < rows.size(); ++i)
    design.row(static_cast<Eigen::Index>(i)) = rows[i].transpose();
  const Eigen::VectorXd distances = Eigen::Map<const Eigen::VectorXd>(right.data(), design.rows());
  const Eigen::VectorXd solution = design.householderQr().solve(distances).head(5);
  const Eigen::VectorXd step = -equations.matrix.inverse() * equations.vector;
  EXPECT_LT((step - solution).norm(), 1e-9 * solution.norm());
  const Eigen::MatrixXd covariance = (design.transpose() * design).inverse().topLeftCorner(5, 5);
  EXPECT_LT((equations.matrix.inverse() - covariance).norm(), 1e-8 * covariance.norm());
  EXPECT_NEAR(equations.chi2, distances.squaredNorm(), 1e-6 * equations.chi2);
}

TEST(SurfelEquations, HoldEachParametersDerivativeOfRanges) {
  const auto scan = test::scan_room(3000, {{0, 0}, {0.004, 0}, {0, 0.003}}, 0.012, 1);
  const SurfelSettings settings;
  const auto surfels = find_surfels(scan.beams(), settings);
  const std::vector<Division> together = {Division(scan.points.size(), 0)};
  const auto equations =
      normal_equations(surfels, scan.beams(), kParameters, derivatives_of(scan), settings, together);
  // An offset of ranges changes each by as much as any other, whatever it counts.
  EXPECT_EQ(equations.changed[4], static_cast<double>(equations.beams));
  EXPECT_NEAR(equations.range_squares[4], equations.changed[4], 1e-9 * 3000);
  // A shift outwards does along the beam what it does across the plane, divided by the cosine.
  double expected = 0;
  double of_laser = 0;
  for (const Surfel& surfel : surfels.surfels) {
    const auto residuals = residuals_of(surfel, surfels, scan.beams(), settings);
    for (std::uint32_t k = surfel.begin; k < surfel.end; ++k) {
      const std::uint32_t i = surfels.members[k];
      const SurfelResidual& r = residuals[k - surfel.begin];
      if (r.weight == 0 || scan.laser[i] != 1) continue;
      expected += std::pow(surfel.normal.dot(scan.outwards[i]) / r.incidence, 2);
      ++of_laser;
    }
  }
  EXPECT_NEAR(equations.range_squares[0], expected, 1e-9 * expected);
  EXPECT_EQ(equations.changed[0], of_laser);
}

TEST(SurfelEquations, LeaveOutNothingWhereManyParametersAreOfSingleLasers) {
  // Each parameter eight times, in units of their own: enough of them for zeros to be left out.
  constexpr std::size_t kCopies = 8;
  constexpr std::size_t kAll = kCopies * kParameters;
  const auto scan = test::scan_room(3000, {{0, 0}, {0.004, 0}, {0, 0.003}}, 0.012, 1);
  const auto surfels = find_surfels(scan.beams(), {});
  Division halves(scan.points.size());
  for (std::size_t i = 0; i < halves.size(); ++i) halves[i] = i % 7 < 3 ? 4 : 1;
  const std::vector<Division> divisions = {halves};
  const auto few = normal_equations(surfels, scan.beams(), kParameters, derivatives_of(scan), {}, divisions);
  const DerivativeRows copied = [&](const Surfel& surfel, std::span<const std::uint32_t> beams,
                                    std::span<const double> range_change, std::span<double> rows) {
    std::vector<double> own(beams.size() * kParameters, 0);
    derivatives_of(scan)(surfel, beams, range_change, own);
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const std::size_t parameter = k % kAll;
      const std::size_t copy = parameter / kParameters;
      rows[k] = static_cast<double>(1 + copy) * own[k / kAll * kParameters + parameter % kParameters];
    }
  };
  const auto many = normal_equations(surfels, scan.beams(), kAll, copied, {}, divisions);
  Eigen::MatrixXd copies = Eigen::MatrixXd::Zero(kAll, kParameters);
  for (Eigen::Index k = 0; k < copies.rows(); ++k) {
    const Eigen::Index copy = k / Eigen::Index{kParameters};
    copies(k, k % Eigen::Index{kParameters}) = static_cast<double>(1 + copy);
  }
  const auto is_near = [](const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    return (a - b).norm() < 1e-10 * b.norm();
  };
  EXPECT_TRUE(is_near(many.matrix, copies * few.matrix * copies.transpose()));
  EXPECT_TRUE(is_near(many.vector, copies * few.vector));
  EXPECT_TRUE(is_near(many.squares, copies.cwiseAbs2() * few.squares));
  EXPECT_TRUE(is_near(many.range_squares, copies.cwiseAbs2() * few.range_squares));
  EXPECT_TRUE(is_near(many.changed, copies.cwiseSign() * few.changed));
  EXPECT_TRUE(is_near(many.block_scores[0], copies * few.block_scores[0]));
  EXPECT_EQ(many.block_scores[0].col(0).norm(), 0) << "a block without beams";
  EXPECT_GT(many.block_scores[0].col(4).norm(), 0);
  EXPECT_NEAR(many.chi2, few.chi2, 1e-9 * few.chi2);
}

TEST(SurfelEquations, FindWhereLasersAreWithinTheirStandardErrors) {
  const Eigen::VectorXd truth = (Eigen::VectorXd(5) << 0.01, -0.005, -0.004, 0.008, 0).finished();
  // Each squared error over its variance is 1 on average: a sum of 40 · 5 has a standard deviation of 20.
  double sum = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const auto scan = test::scan_room(3000, {{0, 0}, {0.01, -0.005}, {-0.004, 0.008}}, 0.012, seed);
    const auto found = estimate(equations_of(scan, {.floor = 1e-4}));
    sum += ((found.value - truth).array() / found.std_error.array()).square().sum();
  }
  EXPECT_NEAR(sum, 200, 4 * 20);
}

TEST(SurfelEquations, DoNotTakeTheNoiseOfRangesForAnOffset) {
  // With regressors at the noisy points a clean scan shows an offset of decimetres; where points are chosen
  // by their noise, one of tenths of a millimetre.
  const auto scan = test::scan_room(100000, {{0, 0}, {0, 0}, {0, 0}}, 0.012, 99);
  const auto found = estimate(equations_of(scan, {}));
  EXPECT_LT(found.std_error[4], 1.5e-4);
  for (Eigen::Index k = 0; k < 5; ++k) EXPECT_LT(std::abs(found.value[k]), 4 * found.std_error[k]) << k;
}

TEST(SurfelEquations, StandOutliers) {
  auto scan = test::scan_room(20000, {{0, 0}, {0.01, -0.005}, {-0.004, 0.008}}, 0.012, 5);
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> shorter(0, 1);
  for (std::size_t i = 0; i < scan.points.size(); i += 20) {
    const double by = shorter(random);
    scan.points.x[i] -= by * scan.directions.x[i];
    scan.points.y[i] -= by * scan.directions.y[i];
    scan.points.z[i] -= by * scan.directions.z[i];
  }
  const auto found = estimate(equations_of(scan, {}));
  const Eigen::VectorXd truth = (Eigen::VectorXd(5) << 0.01, -0.005, -0.004, 0.008, 0).finished();
  for (Eigen::Index k = 0; k < 5; ++k) EXPECT_NEAR(found.value[k], truth[k], 4 * found.std_error[k]) << k;
}

TEST(SurfelEquations, HoldForWhateverNoiseThereIs) {
  const auto scan = test::scan_room(10000, {{0, 0}, {0, 0}, {0, 0}}, 0.006, 7);
  const auto finer = estimate(equations_of(scan, {.noise = 0.006, .floor = 1e-4}));
  const auto thought_coarser = estimate(equations_of(scan, {.noise = 0.012, .floor = 1e-4}));
  for (Eigen::Index k = 0; k < 5; ++k) {
    EXPECT_NEAR(thought_coarser.std_error[k] / finer.std_error[k], 1, 0.1) << k;
  }
}

TEST(SurfelEquations, ReduceToWhatOtherParametersCannotExplain) {
  NormalEquations equations(3);
  equations.matrix << 4, 2, 1, 2, 3, 0.5, 1, 0.5, 2;
  equations.vector << 1, -1, 0.5;
  equations.degrees_of_freedom = 10;
  const auto reduced = equations.reduced({2}, {0, 1});
  // The inverse's corner is the inverse of what is left; and the solution stays the same.
  EXPECT_NEAR(reduced.matrix(0, 0), 1 / equations.matrix.inverse()(2, 2), 1e-12);
  EXPECT_NEAR(-reduced.vector[0] / reduced.matrix(0, 0),
              -equations.matrix.inverse().row(2).dot(equations.vector), 1e-12);
  // Two parameters that do the same: nothing is left of one without the other.
  equations.matrix << 4, 2, 4, 2, 3, 2, 4, 2, 4;
  equations.vector << 1, -1, 1;
  EXPECT_NEAR(equations.reduced({2}, {0, 1}).matrix(0, 0), 0, 1e-9);
  EXPECT_NEAR(equations.reduced({1}, {0, 2}).matrix(0, 0), 2, 1e-9);
  EXPECT_EQ(equations.reduced({1}, {}).matrix(0, 0), 3);
}

/// Beams of a scan in the order of firing, in pieces: 50 of each laser.
Division pieces_of(const test::RoomScan& scan) {
  const std::size_t beams = scan.laser.size() / 3;
  Division pieces(scan.laser.size());
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    pieces[i] = static_cast<std::uint32_t>(50 * (i % beams) / beams + 50 * scan.laser[i]);
  }
  return pieces;
}

TEST(ScatterOfBlocks, IsThatOfTheirBeamsWhereErrorsAreTheirOwn) {
  const auto scan = test::scan_room(10000, {{0, 0}, {0, 0}, {0, 0}}, 0.012, 11);
  const SurfelSettings settings{.floor = 1e-4};
  const auto surfels = find_surfels(scan.beams(), settings);
  const auto rows = derivatives_of(scan);
  const std::vector<Division> divisions{Division(scan.laser.size(), 0), pieces_of(scan)};
  const auto equations = normal_equations(surfels, scan.beams(), kParameters, rows, settings, divisions);
  for (const Eigen::MatrixXd& block_scores : equations.block_scores) {
    EXPECT_NEAR((block_scores.rowwise().sum() - equations.vector).norm(), 0, 1e-9 * equations.vector.norm());
  }
  const Eigen::MatrixXd block_scores =
      equations.scores_along(1, {0, 1, 2, 3, 4}, Eigen::MatrixXd::Identity(kParameters, kParameters));
  const Eigen::MatrixXd scatter = block_scores * block_scores.transpose();
  const Eigen::MatrixXd expected = equations.covariance_factor() * equations.matrix;
  // The sum of squares of k independent block_scores has a relative standard deviation of √(2/k); each of the
  // lasers' own parameters has 50, the common one 150.
  for (Eigen::Index k = 0; k < 5; ++k) {
    EXPECT_NEAR(scatter(k, k) / expected(k, k), 1, 4 * std::sqrt(2.0 / (k < 4 ? 50 : 150))) << k;
  }
}

TEST(ScatterOfBlocks, KnowsOfErrorsThatBeamsShare) {
  // Each piece of a laser's beams is off along the laser's motion by an error of its own. Thirty estimates of
  // two parameters: the sum of their squared errors in units of the variances is 60 ± 11.
  double by_pieces = 0;
  double by_beams = 0;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    auto scan = test::scan_room(3000, {{0, 0}, {0, 0}, {0, 0}}, 0.012, seed);
    const auto pieces = pieces_of(scan);
    std::mt19937_64 random(seed);
    std::normal_distribution<double> shared(0, 0.01);
    std::vector<double> off(150);
    for (double& error : off) error = shared(random);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      scan.points.x[i] -= off[pieces[i]] * scan.outwards[i].y();
      scan.points.y[i] += off[pieces[i]] * scan.outwards[i].x();
    }
    const SurfelSettings settings{.floor = 1e-4};
    const auto surfels = find_surfels(scan.beams(), settings);
    const auto rows = derivatives_of(scan);
    const std::array divisions{pieces};
    const auto equations = normal_equations(surfels, scan.beams(), kParameters, rows, settings, divisions);
    const Eigen::MatrixXd inverse = equations.matrix.inverse();
    const Eigen::VectorXd variance =
        equations.scores_along(0, {0, 1, 2, 3, 4}, inverse).rowwise().squaredNorm();
    const auto found = estimate(equations);
    for (const Eigen::Index k : {1, 3}) {
      by_pieces += found.value[k] * found.value[k] / variance[k];
      by_beams += std::pow(found.value[k] / found.std_error[k], 2);
    }
  }
  EXPECT_NEAR(by_pieces, 60, 4 * 11);
  EXPECT_GT(by_beams, 2 * 60);
}

/// By how much a turn about the z axis moves the place where a beam meets a surfel across it [m/rad], by
/// differences.
double moved_by_turn(const Surfel& surfel, const SurfelResidual& r) {
  constexpr double kStep = 1e-6;
  const Eigen::Vector3d foot = surfel.middle + r.u * surfel.u + r.v * surfel.v;
  const auto turned = [&](double angle) {
    return surfel.normal.dot(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()) * foot);
  };
  return (turned(kStep) - turned(-kStep)) / (2 * kStep);
}

TEST(SharedTurns, AreUnknownsLikeOthersOfWhichSomethingIsKnown) {
  // One great least-squares problem once more, planes and turns among its unknowns.
  const auto scan = test::scan_room(1500, {{0, 0}, {0, 0}, {0, 0}}, 0.012, 1);
  const auto moments = pieces_of(scan);
  std::vector<double> variances;
  for (int moment = 0; moment < 150; ++moment) variances.push_back(1e-6 * (1 + moment % 7));
  const SurfelSettings settings{.outlier = 0};
  const auto surfels = find_surfels(scan.beams(), settings);
  const Eigen::Index planes = 3 * static_cast<Eigen::Index>(surfels.surfels.size());
  const Eigen::Index unknowns = 5 + planes + 150;
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(unknowns, unknowns);
  for (Eigen::Index moment = 0; moment < 150; ++moment) {
    matrix(5 + planes + moment, 5 + planes + moment) = 1 / variances[static_cast<std::size_t>(moment)];
  }
  for (std::size_t s = 0; s < surfels.surfels.size(); ++s) {
    const Surfel& surfel = surfels.surfels[s];
    const auto residuals = residuals_of(surfel, surfels, scan.beams(), settings);
    for (std::uint32_t k = surfel.begin; k < surfel.end; ++k) {
      const SurfelResidual& r = residuals[k - surfel.begin];
      if (r.weight == 0) continue;
      Eigen::VectorXd row = Eigen::VectorXd::Zero(unknowns);
      std::vector<double> own(kParameters, 0);
      derivatives_of(scan)(surfel, std::span(&surfels.members[k], 1), std::span(&r.range_change, 1), own);
      row.head(5) = Eigen::Map<const Eigen::VectorXd>(own.data(), 5);
      row.segment<3>(5 + 3 * static_cast<Eigen::Index>(s)) = Eigen::Vector3d(1, r.u, r.v);
      row[5 + planes + moments[surfels.members[k]]] = moved_by_turn(surfel, r);
      matrix += row * row.transpose() / (r.spread * r.spread);
    }
  }
  const Eigen::MatrixXd covariance = matrix.inverse().topLeftCorner(5, 5);
  const Eigen::MatrixXd information =
      information_with_turns(surfels, scan.beams(), kParameters, derivatives_of(scan), settings,
                             {.moments = moments, .variances = variances});
  // Differences know a turn to 10⁻¹⁰ of a metre; the rest is rounding.
  EXPECT_LT((information.inverse() - covariance).norm(), 1e-6 * covariance.norm());
}

TEST(SharedTurns, AreEmptyWithoutSharedErrors) {
  const auto scan = test::scan_room(3000, {{0, 0}, {0, 0}, {0, 0}}, 0.012, 2);
  const auto moments = pieces_of(scan);
  const std::vector<double> none(150, 1e-20);
  const auto surfels = find_surfels(scan.beams(), {});
  const auto rows = derivatives_of(scan);
  const Eigen::MatrixXd without = normal_equations(surfels, scan.beams(), kParameters, rows, {}).matrix;
  const Eigen::MatrixXd with = information_with_turns(surfels, scan.beams(), kParameters, rows, {},
                                                      {.moments = moments, .variances = none});
  EXPECT_LT((with - without).norm(), 1e-6 * without.norm());
}

TEST(SurfelEquations, AreTheSameToTheLastBitOnAnyNumberOfThreads) {
  const auto scan = test::scan_room(10000, {{0, 0}, {0.01, 0}, {0, 0.01}}, 0.012, 8);
  const auto many = equations_of(scan, {});
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const auto one = equations_of(scan, {});
  EXPECT_EQ(one.matrix, many.matrix);
  EXPECT_EQ(one.vector, many.vector);
  EXPECT_EQ(one.chi2, many.chi2);
}

TEST(SharedTurns, AreTheSameToTheLastBitOnAnyNumberOfThreads) {
  const auto scan = test::scan_room(10000, {{0, 0}, {0.01, 0}, {0, 0.01}}, 0.012, 8);
  const auto moments = pieces_of(scan);
  const std::vector<double> variances(150, 1e-6);
  const auto surfels = find_surfels(scan.beams(), {});
  const auto information = [&] {
    return information_with_turns(surfels, scan.beams(), kParameters, derivatives_of(scan), {},
                                  {.moments = moments, .variances = variances});
  };
  const auto many = information();
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(information(), many);
}

}  // namespace
}  // namespace crisp
