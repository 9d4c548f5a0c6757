// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/quality/wall_segments.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "pipeline/quality/plane.hpp"

namespace crisp::quality {
namespace {

/// Pieces of one line, in the order of azimuth.
struct Wall {
  std::vector<Run> runs;
  LineSums sums;
  std::size_t beams = 0;
};

/// Beams in the order of their azimuth.
class Panorama {
 public:
  Panorama(const PointsView& points, double noise)
      : points_(points), order_(by_azimuth(points)), running_(running_sums(points, order_, noise)) {}

  std::vector<Wall> walls(const RunPrices& prices) const {
    std::vector<Wall> walls;
    for (const Run& run : straight_runs(running_, prices)) {
      walls.push_back({{run}, running_[run.end] - running_[run.begin], run.end - run.begin});
    }
    return walls;
  }

  /// [m] From one piece's end to the other's.
  double between(const Run& a, const Run& b) const {
    double least = std::numeric_limits<double>::infinity();
    for (const std::size_t p : {a.begin, a.end - 1}) {
      for (const std::size_t q : {b.begin, b.end - 1}) least = std::min(least, (at(p) - at(q)).norm());
    }
    return least;
  }

  std::size_t size() const { return order_.size(); }
  std::uint32_t beam(std::size_t place) const { return order_[place]; }

 private:
  Eigen::Vector2d at(std::size_t place) const { return {points_.x[order_[place]], points_.y[order_[place]]}; }

  const PointsView& points_;
  std::vector<std::uint32_t> order_;
  std::vector<LineSums> running_;
};

/// Leaves out short runs of whose neighbours many are on nothing straight.
void leave_out_chance(std::vector<Wall>& walls, std::size_t beams) {
  constexpr std::size_t kShort = 12;   // beams
  constexpr std::size_t kNextTo = 30;  // beams, to either side
  constexpr double kMany = 0.4;
  std::vector<std::size_t> outliers(beams + 1, 1);  // among those before
  outliers[0] = 0;
  for (const Wall& wall : walls) {
    const Run& run = wall.runs.front();
    std::fill_n(outliers.begin() + static_cast<std::ptrdiff_t>(run.begin) + 1, run.end - run.begin, 0);
  }
  std::partial_sum(outliers.begin(), outliers.end(), outliers.begin());
  std::erase_if(walls, [&](const Wall& wall) {
    const Run& run = wall.runs.front();
    const std::size_t first = run.begin - std::min(run.begin, kNextTo);
    const std::size_t last = std::min(beams, run.end + kNextTo);
    const auto given = static_cast<double>(2 * kNextTo);
    return wall.beams<kShort&& static_cast<double>(outliers[last] - outliers[first])> kMany * given;
  });
}

/// Whether both are one line, as far as noise lets one see.
bool is_one_line(const Wall& a, const Wall& b) {
  constexpr double kChance = 12;  // χ² of two numbers is beyond once in 400
  return (a.sums + b.sums).left() - a.sums.left() - b.sums.left() < kChance;
}

bool is_near(const Wall& a, const Wall& b, const Panorama& panorama, double gap) {
  return std::ranges::any_of(a.runs, [&](const Run& one) {
    return std::ranges::any_of(b.runs, [&](const Run& other) { return panorama.between(one, other) <= gap; });
  });
}

/// Joins pieces to the largest wall that they go on, again and again while walls grow.
void join(std::vector<Wall>& walls, const Panorama& panorama, double gap) {
  std::ranges::stable_sort(walls, std::ranges::greater{}, &Wall::beams);
  for (std::size_t a = 0; a < walls.size(); ++a) {
    for (std::size_t b = a + 1; b < walls.size();) {
      if (!is_near(walls[a], walls[b], panorama, gap) || !is_one_line(walls[a], walls[b])) {
        ++b;
        continue;
      }
      walls[a].runs.insert(walls[a].runs.end(), walls[b].runs.begin(), walls[b].runs.end());
      walls[a].sums = walls[a].sums + walls[b].sums;
      walls[a].beams += walls[b].beams;
      walls.erase(walls.begin() + static_cast<std::ptrdiff_t>(b));
      b = a + 1;  // those that were too far off may now be near
    }
  }
  std::ranges::stable_sort(walls, std::ranges::greater{}, &Wall::beams);
}

std::vector<std::uint32_t> members_of(const Wall& wall, const Panorama& panorama) {
  std::vector<std::uint32_t> members;
  for (const Run& run : wall.runs) {
    for (std::size_t place = run.begin; place < run.end; ++place) members.push_back(panorama.beam(place));
  }
  std::ranges::sort(members);
  return members;
}

/// The upright plane of these beams, without their positions among others.
Surfel upright(const Eigen::Vector2d& line, const std::vector<std::uint32_t>& members,
               const PointsView& points) {
  Moments moments;
  for (const std::uint32_t i : members) moments.add({points.x[i], points.y[i], points.z[i]});
  Surfel surfel;
  surfel.middle = moments.sum / moments.count;
  surfel.normal << -line.normalized(), 0;
  surfel.v = Eigen::Vector3d::UnitZ();
  surfel.u = surfel.v.cross(surfel.normal);
  const Eigen::Matrix3d spread = moments.squares / moments.count - surfel.middle * surfel.middle.transpose();
  surfel.thickness = std::sqrt(std::max(0.0, surfel.normal.dot(spread * surfel.normal)));
  surfel.radius = std::sqrt(std::max(0.0, surfel.u.dot(spread * surfel.u)));
  return surfel;
}

}  // namespace

Surfels wall_lines(const BeamsView& beams, const WallLineSettings& settings) {
  check(beams.points);
  const Panorama panorama(beams.points, settings.noise);
  auto walls = panorama.walls(settings.prices);
  leave_out_chance(walls, panorama.size());
  join(walls, panorama, settings.gap);
  Surfels result;
  for (const Wall& wall : walls) {
    if (wall.beams < settings.fewest) break;
    const auto members = members_of(wall, panorama);
    const Surfel surfel = upright(wall.sums.line(), members, beams.points);
    if (surfel.radius < settings.noise) continue;  // one spot, from which the plate did not turn away
    result.add(surfel, members);
  }
  return result;
}

}  // namespace crisp::quality
