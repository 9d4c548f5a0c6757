// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/model/terms/shape.hpp"

#include <fmt/format.h>

#include <cmath>
#include <tuple>

namespace crisp::model {

Shape Shape::fourier(int first, int last) {
  Shape shape(Kind::kFourier);
  shape.first_order_ = static_cast<std::size_t>(first);
  shape.count_ = static_cast<std::size_t>(last) - shape.first_order_ + 1;
  return shape;
}

Shape Shape::hats(std::vector<double> knots) {
  Shape shape(Kind::kHats);
  shape.knots_ = std::move(knots);
  return shape;
}

Shape Shape::splines(int n, double from, double to, double zero) {
  Shape shape(Kind::kSplines);
  shape.count_ = static_cast<std::size_t>(n) + 1;
  shape.knots_ = {from, to};
  const double pieces = n - 2;
  shape.omitted_ = static_cast<std::size_t>(1 + std::lround((zero - from) / (to - from) * pieces));
  std::tie(shape.at_zero_, shape.first_at_zero_) = shape.splines_about(zero);
  return shape;
}

Shape Shape::powers() { return Shape(Kind::kPowers); }
Shape Shape::curve() { return Shape(Kind::kCurve); }

std::size_t Shape::coefficients() const {
  switch (kind_) {
    case Kind::kFourier:
      return 2 * count_;
    case Kind::kHats:
      return knots_.size();
    case Kind::kSplines:
      return count_ - 1;
    case Kind::kPowers:
      return 3;
    case Kind::kCurve:
      return 2;
  }
  return 0;
}

double Shape::scale() const {
  constexpr double kOfPowers = 1e-3;  // a plate turns at ten radians a second
  constexpr double kOfCurve = 1e-2;   // a range is some metres
  return kind_ == Kind::kPowers ? kOfPowers : kind_ == Kind::kCurve ? kOfCurve : 1;
}

std::string Shape::name(std::size_t coefficient) const {
  switch (kind_) {
    case Kind::kFourier:
      return fmt::format("{}{}", coefficient % 2 == 0 ? "cos" : "sin", first_order_ + coefficient / 2);
    case Kind::kHats:
    case Kind::kSplines:
      return "at" + std::to_string(coefficient);
    case Kind::kPowers:
    case Kind::kCurve:
      return std::string(1, static_cast<char>('a' + coefficient));
  }
  return {};
}

std::string Shape::summary(std::size_t coefficient) const {
  switch (kind_) {
    case Kind::kFourier:
      return fmt::format("of {} {}x", coefficient % 2 == 0 ? "cos" : "sin", first_order_ + coefficient / 2);
    case Kind::kHats:
      return fmt::format("at x = {:.2f}", knots_[coefficient]);
    case Kind::kSplines: {
      const auto spline = static_cast<double>(coefficient + (coefficient < omitted_ ? 0 : 1));
      const double share = (spline - 1) / static_cast<double>(count_ - 3);
      return fmt::format("of the B-spline about x = {:.2f}", std::lerp(knots_[0], knots_[1], share));
    }
    case Kind::kPowers:
      return std::vector<std::string>{"of x²", "of x abs(x)", "of x³"}.at(coefficient);
    case Kind::kCurve:
      return std::vector<std::string>{"of x²", "of x³"}.at(coefficient);
  }
  return {};
}

}  // namespace crisp::model
