// SPDX-License-Identifier: BSD-3-Clause
#include <numbers>
#include <stdexcept>

#include "tests/independent/scene_builder.hpp"

namespace independent {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

/// A rectangle that holds the scanner, not in its middle.
struct Floor {
  double left, right, back, front;
};

Floor rectangle(SceneBuilder& b, double length, double width) {
  const double u = b.between(0.25, 0.75), v = b.between(0.25, 0.75);
  return {-u * length, (1 - u) * length, -v * width, (1 - v) * width};
}

void enclose(SceneBuilder& b, const Floor& f, double height) {
  b.shell({(f.left + f.right) / 2, (f.back + f.front) / 2, height / 2},
          {f.right - f.left, f.front - f.back, height});
}

Vector somewhere(SceneBuilder& b, const Floor& f) {
  return {b.between(f.left, f.right), b.between(f.back, f.front), 0};
}

/// A point on the foot of one of the four walls, and the yaw of that wall.
std::pair<Vector, double> along_wall(SceneBuilder& b, const Floor& f, double depth) {
  switch (b.count(0, 3)) {
    case 0:
      return {{b.between(f.left, f.right), f.back + depth / 2, 0}, 0};
    case 1:
      return {{b.between(f.left, f.right), f.front - depth / 2, 0}, kTurn / 2};
    case 2:
      return {{f.left + depth / 2, b.between(f.back, f.front), 0}, kTurn / 4};
    default:
      return {{f.right - depth / 2, b.between(f.back, f.front), 0}, -kTurn / 4};
  }
}

void office(SceneBuilder& b) {
  const Floor floor = rectangle(b, b.between(4.5, 9), b.between(4, 7));
  const double height = b.between(2.4, 3.1);
  enclose(b, floor, height);
  for (int i = b.count(3, 7); i > 0; --i) {  // cupboards and shelves
    const double depth = b.between(0.25, 0.6);
    const auto [at, yaw] = along_wall(b, floor, depth);
    b.box(at, yaw, {b.between(0.5, 1.6), depth, b.between(0.7, 2.1)});
  }
  for (int i = b.count(2, 5); i > 0; --i) {
    const Vector at = somewhere(b, floor);
    const double yaw = b.chance(0.7) ? kTurn / 4 * b.count(0, 3) : b.between(0, kTurn);
    b.table(at, yaw, b.between(1.2, 1.8), b.between(0.6, 0.9), b.between(0.68, 0.78));
    b.box(at + Vector{0, 0, 0.75}, yaw + b.between(-0.4, 0.4), {0.55, 0.05, 0.35});  // a screen
    b.chair(at - b.between(0.6, 1.0) * turned_about_vertical(yaw).y, yaw + b.between(-1, 1));
  }
  for (int i = b.count(1, 3); i > 0; --i)
    b.ball(somewhere(b, floor) + Vector{0, 0, height - 0.5}, {0.2, 0.2, 0.15});
  for (int i = b.count(0, 2); i > 0; --i) b.post(somewhere(b, floor), b.between(0.1, 0.25), height);
  for (int i = b.count(1, 3); i > 0; --i) {  // plants
    const Vector at = somewhere(b, floor);
    b.post(at, 0.18, 0.4);
    b.ball(at + Vector{0, 0, 0.8}, {0.3, 0.3, 0.45});
  }
}

void hall(SceneBuilder& b) {
  const Floor floor = rectangle(b, b.between(12, 30), b.between(10, 22));
  const double height = b.between(4, 9);
  enclose(b, floor, height);
  const double pitch = b.between(4, 7), shift_x = b.between(0, pitch), shift_y = b.between(0, pitch);
  const bool is_round = b.chance(0.5);
  const double thickness = b.between(0.2, 0.45);
  for (double x = floor.left + shift_x; x < floor.right; x += pitch) {
    b.box({x, (floor.back + floor.front) / 2, height - 0.5}, 0,
          {0.3, floor.front - floor.back, 0.5});  // a beam
    for (double y = floor.back + shift_y; y < floor.front; y += pitch) {
      if (is_round)
        b.post({x, y, 0}, thickness, height);
      else
        b.box({x, y, 0}, 0, {2 * thickness, 1.5 * thickness, height});
    }
  }
  for (int i = b.count(6, 16); i > 0; --i) {
    b.box(somewhere(b, floor), b.between(0, kTurn),
          {b.between(0.4, 2), b.between(0.4, 1.5), b.between(0.3, 2.2)});
  }
  for (int i = b.count(2, 6); i > 0; --i) {
    const double depth = b.between(0.2, 0.8);
    const auto [at, yaw] = along_wall(b, floor, depth);
    b.box(at, yaw, {b.between(1, 4), depth, b.between(1, 3.5)});
  }
}

void street(SceneBuilder& b) {
  b.shell({0, 0, -0.5}, {400, 400, 1});
  for (const double side : {-1.0, 1.0}) {
    const double setback = b.between(4, 11);
    for (double x = -45 + b.between(0, 8); x < 45;) {
      const double width = b.between(5, 14), depth = b.between(6, 10), height = b.between(3.5, 14);
      const double front = setback + b.between(0, 1.5), yaw = b.between(-0.06, 0.06);
      b.box({x + width / 2, side * (front + depth / 2), 0}, yaw, {width, depth, height});
      for (int i = b.count(0, 3); i > 0; --i) {  // porches and balconies
        const double at = x + b.between(0.1, 0.9) * width, bottom = b.chance(0.5) ? 0 : b.between(2.5, 5);
        b.box({at, side * front, bottom}, yaw, {b.between(1, 2.5), b.between(0.5, 2), b.between(0.9, 2.4)});
      }
      x += width + (b.chance(0.4) ? b.between(1.5, 7) : 0.02);
    }
    b.box({0, side * (setback - 1.2), 0}, 0, {90, 2.4, 0.14});                // the pavement
    for (double x = -30 + b.between(0, 6); x < 30; x += b.between(4.8, 9)) {  // parked cars
      if (b.chance(0.35)) continue;
      const double yaw = b.between(-0.05, 0.05), y = side * (setback - 3.5);
      if (b.box({x, y, 0.2}, yaw, {4.2, 1.7, 0.65})) b.box({x - 0.3, y, 0.85}, yaw, {2.1, 1.5, 0.6});
    }
    for (double x = -35 + b.between(0, 9); x < 35; x += b.between(6, 14)) {
      const Vector foot{x, side * (setback - b.between(1.0, 2.2)), 0};
      if (b.chance(0.5)) {
        b.post(foot, b.between(0.05, 0.12), b.between(3, 7));
      } else if (b.post(foot, b.between(0.1, 0.25), 3.2)) {
        b.ball(foot + Vector{0, 0, 4.4}, {b.between(1, 1.8), b.between(1, 1.8), b.between(1.2, 2)});
      }
    }
  }
}

void tunnel(SceneBuilder& b) {
  const double width = b.between(2.4, 6), height = b.between(2.4, 5), length = b.between(25, 80);
  const double u = b.between(0.4, 0.6), v = b.between(0.4, 0.6);
  const Floor floor{-u * length, (1 - u) * length, -v * width, (1 - v) * width};
  enclose(b, floor, height);
  for (double x = floor.left + b.between(0.5, 3); x < floor.right; x += b.between(2.5, 5)) {  // ribs
    const double depth = b.between(0.1, 0.25);
    for (const double y : {floor.back, floor.front}) b.box({x, y, 0}, 0, {0.3, 2 * depth, height});
    b.box({x, (floor.back + floor.front) / 2, height - depth}, 0, {0.3, width, depth});
  }
  for (int i = b.count(1, 4); i > 0; --i) {
    const double radius = b.between(0.04, 0.2), y = b.chance(0.5) ? floor.back + 0.3 : floor.front - 0.3;
    b.pipe({0, y, b.between(0.3, height - 0.3)}, 0, radius, length);
  }
  for (int i = b.count(5, 12); i > 0; --i) {  // cabinets and crates along the sides
    const double depth = b.between(0.25, 0.7),
                 y = b.chance(0.5) ? floor.back + depth / 2 : floor.front - depth / 2;
    b.box({b.between(floor.left, floor.right) / 2, y, 0}, b.between(-0.15, 0.15),
          {b.between(0.4, 2), depth, b.between(0.4, 2)});
  }
  const double end = b.sign() > 0 ? floor.right : floor.left;
  b.box({end / b.between(2, 5), b.between(-1, 1) * width / 3, 0}, b.between(0, kTurn),
        {1.2, 0.8, 1.1});  // a cart
}

void workshop(SceneBuilder& b) {
  const Floor floor = rectangle(b, b.between(7, 15), b.between(6, 12));
  const double height = b.between(2.8, 5);
  enclose(b, floor, height);
  for (int i = b.count(3, 7); i > 0; --i) {
    const double depth = b.between(0.6, 0.9);
    const auto [at, yaw] = along_wall(b, floor, depth);
    b.table(at, yaw, b.between(1.5, 3), depth, b.between(0.8, 1.0));
    for (int k = b.count(1, 4); k > 0; --k) {  // what lies on the bench
      const Vector place = at + Vector{b.between(-0.4, 0.4), b.between(-0.4, 0.4), 1.0};
      if (b.chance(0.5))
        b.box(place, b.between(0, kTurn), {b.between(0.1, 0.5), b.between(0.1, 0.4), b.between(0.1, 0.5)});
      else
        b.post(place, b.between(0.05, 0.2), b.between(0.1, 0.5));
    }
  }
  for (int i = b.count(4, 9); i > 0; --i) {  // machines
    const Vector at = somewhere(b, floor);
    const double yaw = b.between(0, kTurn), tall = b.between(0.6, 1.6);
    if (!b.box(at, yaw, {b.between(0.5, 1.6), b.between(0.5, 1.2), tall})) continue;
    if (b.chance(0.5))
      b.pipe(at + Vector{0, 0, tall + 0.2}, yaw, b.between(0.08, 0.25), b.between(0.5, 1.5));
    else
      b.ball(at + Vector{0, 0, tall + 0.2}, {b.between(0.15, 0.4), b.between(0.15, 0.4), 0.25});
  }
  for (int i = b.count(2, 6); i > 0; --i) {  // boards that lean
    const Vector at = somewhere(b, floor) + Vector{0, 0, 0.8};
    const Axes yawed = turned_about_vertical(b.between(0, kTurn));
    b.add(Form::box, at, rotated(yawed, yawed.x, b.sign() * b.between(0.1, 0.9)),
          {b.between(0.3, 1), 0.015, b.between(0.5, 0.9)});
  }
  for (int i = b.count(2, 6); i > 0; --i)
    b.post(somewhere(b, floor), b.between(0.25, 0.35), b.between(0.85, 0.95));
  for (int i = b.count(1, 4); i > 0; --i) {
    b.pipe(somewhere(b, floor) + Vector{0, 0, height - b.between(0.2, 0.6)}, kTurn / 4 * b.count(0, 1),
           b.between(0.05, 0.25), b.between(4, 12));
  }
}

}  // namespace

World build_scene(const std::string& name, double height, std::mt19937_64 random) {
  SceneBuilder builder(height, random);
  if (name == "office")
    office(builder);
  else if (name == "hall")
    hall(builder);
  else if (name == "street")
    street(builder);
  else if (name == "tunnel")
    tunnel(builder);
  else if (name == "workshop")
    workshop(builder);
  else
    throw std::runtime_error("scene " + name + " is unknown");
  return builder.world();
}

}  // namespace independent
