// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/scenes.hpp"

#include <iterator>
#include <numbers>

#include "grabbers/simulate/shapes.hpp"

namespace crisp {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180;

void add(std::vector<Surface>& to, std::vector<Surface> surfaces) {
  to.insert(to.end(), std::make_move_iterator(surfaces.begin()), std::make_move_iterator(surfaces.end()));
}

void add_desk(std::vector<Surface>& to, const Eigen::Vector2d& corner, double yaw) {
  const Vector3d at(corner.x(), corner.y(), 0);
  std::vector<Surface> desk;
  add(desk, box("desk", at + Vector3d(0, 0, 0.70), at + Vector3d(1.6, 0.8, 0.73), 0.6));
  add(desk, box("desk side", at + Vector3d(0.02, 0.05, 0), at + Vector3d(0.05, 0.75, 0.70), 0.5));
  add(desk, box("desk drawers", at + Vector3d(1.15, 0.05, 0), at + Vector3d(1.57, 0.75, 0.70), 0.5));
  add(desk, box("screen", at + Vector3d(0.5, 0.15, 0.80), at + Vector3d(1.1, 0.19, 1.16), 0.1));
  turn(desk, corner + Eigen::Vector2d(0.8, 0.4), yaw);
  add(to, std::move(desk));
}

}  // namespace

Scene office() {
  std::vector<Surface> room;
  const double width = 10;
  const double depth = 8;
  const double height = 3;
  room.push_back(rectangle("floor", {0, 0, 0}, {width, 0, 0}, {0, depth, 0}, 0.25));
  room.push_back(rectangle("ceiling", {0, 0, height}, {width, 0, 0}, {0, depth, 0}, 0.85));
  add(room, walls("wall", {{0, 0}, {width, 0}, {width, depth}, {0, depth}}, 0, height, 0.75));
  for (double x : {1.0, 8.0}) add(room, box("door", {x, 0, 0}, {x + 0.95, 0.06, 2.05}, 0.45));
  for (double x : {1.2, 4.2, 7.2}) {
    add(room, box("window sill", {x, depth - 0.22, 0.85}, {x + 1.8, depth, 0.9}, 0.7));
    add(room, box("radiator", {x + 0.2, depth - 0.14, 0.15}, {x + 1.6, depth - 0.04, 0.75}, 0.8));
  }
  add(room, box("cupboard", {0, 2.0, 0}, {0.45, 4.4, 2.1}, 0.5));
  add(room, box("low cupboard", {0, 5.0, 0}, {0.42, 7.0, 0.9}, 0.4));
  add(room, box("bookcase", {9.65, 1.2, 0}, {width, 3.6, 2.3}, 0.35));
  add(room, box("column", {9.6, 5.6, 0}, {width, 6.0, height}, 0.75));
  add(room, box("beam", {0, 5.0, 2.75}, {width, 5.3, height}, 0.8));
  add(room, box("partition", {6.2, 0, 0}, {6.28, 2.6, 1.7}, 0.3));
  add_desk(room, {1.6, 5.6}, 0);
  add_desk(room, {7.2, 5.2}, 12 * kDegree);
  add_desk(room, {7.4, 1.2}, -90 * kDegree);
  add_desk(room, {2.6, 0.9}, 35 * kDegree);
  look_from(room, {4.7, 3.9, 1.15}, 17 * kDegree);
  return {"office", std::move(room)};
}

Scene hall() {
  std::vector<Surface> room;
  const double width = 30;
  const double depth = 20;
  const double height = 8;
  room.push_back(rectangle("floor", {0, 0, 0}, {width, 0, 0}, {0, depth, 0}, 0.3));
  room.push_back(rectangle("ceiling", {0, 0, height}, {width, 0, 0}, {0, depth, 0}, 0.6));
  add(room, walls("wall", {{0, 0}, {width, 0}, {width, depth}, {0, depth}}, 0, height, 0.6));
  for (double x : {5.0, 11.0, 17.0, 23.0}) {
    for (double y : {5.5, 13.5}) add(room, box("pillar", {x, y, 0}, {x + 0.6, y + 0.6, height}, 0.5));
    add(room, box("girder", {x + 0.15, 0, 7.3}, {x + 0.45, depth, height}, 0.4));
  }
  add(room, box("gallery", {0, 17, 3.4}, {width, depth, 3.7}, 0.45));
  add(room, box("gate", {29.85, 7, 0}, {width, 11.5, 4.5}, 0.35));
  for (double x : {2.0, 8.5, 14.5, 20.5}) add(room, box("recess", {x, 0, 0.8}, {x + 2.4, 0.3, 4.2}, 0.7));
  std::vector<Surface> crates;
  add(crates, box("crate", {21, 2.2, 0}, {22.2, 3.4, 1.2}, 0.4));
  add(crates, box("crate", {21.1, 2.3, 1.2}, {22.0, 3.2, 2.1}, 0.4));
  add(crates, box("crate", {22.6, 2.4, 0}, {23.6, 3.4, 1.0}, 0.55));
  turn(crates, {22, 3}, 28 * kDegree);
  add(room, std::move(crates));
  std::vector<Surface> shelves = box("shelf", {3, 8.6, 0}, {3.8, 12.4, 2.8}, 0.3);
  turn(shelves, {3.4, 10.5}, -8 * kDegree);
  add(room, std::move(shelves));
  look_from(room, {13.2, 9.1, 1.3}, -23 * kDegree);
  return {"hall", std::move(room)};
}

Scene street() {
  std::vector<Surface> town;
  const double from = -60;
  const double to = 60;
  const double kerb = 0.12;
  town.push_back(rectangle("road", {from, -3.5, 0}, {to - from, 0, 0}, {0, 7, 0}, 0.15));
  for (double side : {-1.0, 1.0}) {
    const double edge = 3.5 * side;
    town.push_back(rectangle("kerb", {from, edge, 0}, {to - from, 0, 0}, {0, 0, kerb}, 0.4));
    town.push_back(rectangle("pavement", {from, edge, kerb}, {to - from, 0, 0}, {0, 4.5 * side, 0}, 0.3));
  }
  // House fronts of 12 m that stand forward or back, each with a door and windows in relief.
  for (int i = 0; i < 10; ++i) {
    const double x = from + 12 * i;
    for (double side : {-1.0, 1.0}) {
      const double back = 0.45 * ((i * 2 + (side > 0 ? 1 : 0)) % 3);
      const double y = side * (6.6 + back);
      const double height = 8.0 + 1.1 * ((i * 3 + (side > 0 ? 2 : 0)) % 4);
      const double reflectance = 0.35 + 0.1 * ((i + (side > 0 ? 1 : 0)) % 4);
      const auto out = [&](double depth) { return y - side * depth; };
      const auto relief = [&](const char* name, double left, double right, double low, double high,
                              double depth) {
        add(town, box(name, {x + left, std::min(y, out(depth)), low},
                      {x + right, std::max(y, out(depth)), high}, 0.6));
      };
      add(town, box("house", {x, std::min(y, 8.0 * side), 0}, {x + 12, std::max(y, 8.0 * side), height},
                    reflectance));
      relief("door", 1.5, 2.7, kerb, 2.4, 0.12);
      for (double left : {3.6, 6.2, 8.8}) {
        relief("window", left, left + 1.3, 1.1, 2.6, 0.10);
        relief("balcony", left, left + 1.3, 4.0, 4.15, 0.7);
      }
    }
  }
  for (int i = 0; i < 5; ++i) {
    const double x = -44 + 22 * i;
    const double y = i % 2 == 0 ? 3.9 : -4.1;
    add(town, box("lamp post", {x, y, kerb}, {x + 0.16, y + 0.16, 6.5}, 0.5));
  }
  for (double x : {-21.0, 9.5, 30.0}) {
    add(town, box("van", {x, 1.35, 0.3}, {x + 4.9, 3.3, 2.3}, 0.7));
    add(town, box("van bonnet", {x + 4.9, 1.4, 0.3}, {x + 5.7, 3.25, 1.2}, 0.7));
  }
  std::vector<Surface> bin = box("container", {-8.5, -5.6, kerb}, {-6.7, -4.5, 1.5}, 0.35);
  turn(bin, {-7.6, -5}, 14 * kDegree);
  add(town, std::move(bin));
  look_from(town, {1.4, -0.6, 1.6}, 9 * kDegree);
  return {"street", std::move(town)};
}

}  // namespace crisp
