// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/report/encoded_cloud.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "pipeline/data/degree.hpp"
#include "pipeline/data/internal_error.hpp"
#include "plugins/report/base64.hpp"

namespace crisp::report {
namespace {

struct ValueRange {
  double low = 0;
  double high = 0;
};

/// For finite values.
template <class Values>
ValueRange range_of(const Values& values) {
  ValueRange range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const auto each : values) {
    const auto value = static_cast<double>(each);
    if (!std::isfinite(value)) continue;
    range.low = std::min(range.low, value);
    range.high = std::max(range.high, value);
  }
  return range.low <= range.high ? range : ValueRange{};
}

struct ColumnFormat {
  unsigned bytes = 2;
  bool delta = false;
  bool gaps = false;
  double offset = 0;
  double step = 1;
};

class Columns {
 public:
  template <class Values>
  void add(const char* name, const Values& values, const ColumnFormat& format) {
    const std::size_t begin = bytes_.size(), n = values.size();
    bytes_.resize(begin + n * format.bytes);
    std::uint32_t previous = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const std::uint32_t number = quantise(static_cast<double>(values[i]), format);
      const std::uint32_t stored = format.delta ? number - previous : number;
      previous = number;
      for (unsigned b = 0; b < format.bytes; ++b) {
        bytes_[begin + b * n + i] = static_cast<unsigned char>(stored >> (8 * b));
      }
    }
    header_.push_back({{"name", name},
                       {"bytes", format.bytes},
                       {"delta", format.delta},
                       {"gaps", format.gaps},
                       {"offset", format.offset},
                       {"step", format.step}});
  }

  /// As fine as the bytes allow, over the range of the values.
  template <class Values>
  void add_scaled(const char* name, const Values& values, unsigned bytes, bool delta) {
    const ValueRange range = range_of(values);
    const double numbers = std::exp2(8.0 * bytes) - 1;
    const double span = std::max(range.high - range.low, std::numeric_limits<double>::min());
    add(name, values, {.bytes = bytes, .delta = delta, .offset = range.low, .step = span / numbers});
  }

  const std::vector<unsigned char>& bytes() const { return bytes_; }
  const nlohmann::ordered_json& header() const { return header_; }

 private:
  static std::uint32_t quantise(double value, const ColumnFormat& format) {
    const double most = std::exp2(8.0 * format.bytes) - 1;
    if (format.gaps && !std::isfinite(value)) return static_cast<std::uint32_t>(most);
    const double number = std::round((value - format.offset) / format.step);
    return static_cast<std::uint32_t>(std::clamp(number, 0.0, format.gaps ? most - 1 : most));
  }

  std::vector<unsigned char> bytes_;
  nlohmann::ordered_json header_ = nlohmann::ordered_json::array();
};

/// Two bytes an axis, or three where the cloud extends farther than they reach.
/// @return [m] the step
double add_points(const std::array<const char*, 3>& names, const Vectors& points, Columns& to) {
  constexpr double kTwoBytes = 65535, kThreeBytes = 16777215;
  double coarsest = 0;
  const std::array<const std::vector<double>*, 3> axes{&points.x, &points.y, &points.z};
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    const ValueRange range = range_of(*axes[axis]);
    const double span = range.high - range.low;
    const double step = std::max(kCoordinateStep, span / kThreeBytes);
    coarsest = std::max(coarsest, step);
    to.add(names[axis], *axes[axis],
           {.bytes = span / step <= kTwoBytes ? 2U : 3U, .delta = true, .offset = range.low, .step = step});
  }
  return coarsest;
}

constexpr ColumnFormat kDistanceFormat{.bytes = 1, .gaps = true, .offset = -0.127, .step = 1e-3};

std::vector<unsigned char> deflated(const std::vector<unsigned char>& bytes) {
  constexpr int kLevel = 3;  // one that is twice as slow makes a report smaller by a twentieth
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::vector<unsigned char> packed(size);
  const int status = compress2(packed.data(), &size, bytes.data(), static_cast<uLong>(bytes.size()), kLevel);
  if (status != Z_OK)
    throw data::internal_error("zlib cannot compress the report's cloud: " + std::to_string(status));
  packed.resize(size);
  return packed;
}

}  // namespace

EncodedCloud encode(const ShownCloud& cloud) {
  Columns columns;
  double step = add_points({"x", "y", "z"}, cloud.after, columns);
  if (cloud.before.size() > 0)
    step = std::max(step, add_points({"x_before", "y_before", "z_before"}, cloud.before, columns));
  columns.add("laser", cloud.laser, {.bytes = 1});
  columns.add("beam", cloud.beam, {.bytes = 2});
  columns.add_scaled("remission", cloud.remission, 1, false);
  columns.add_scaled("time", cloud.time, 2, false);
  columns.add("distance", cloud.distance, kDistanceFormat);
  if (!cloud.distance_before.empty()) columns.add("distance_before", cloud.distance_before, kDistanceFormat);
  if (!cloud.range.empty()) {
    constexpr double kRangeStep = 2e-3;  // [m]
    columns.add("range", cloud.range, {.bytes = 2, .step = kRangeStep});
  }
  if (!cloud.incidence.empty()) {
    std::vector<double> degrees = cloud.incidence;
    for (double& angle : degrees) angle /= data::kDegree;
    columns.add("incidence", degrees, {.bytes = 1, .gaps = true});
  }
  return {.header = {{"points", cloud.size()},
                     {"of", cloud.of},
                     {"error", step / 2},
                     {"columns", columns.header()}},
          .base64 = base64_of(deflated(columns.bytes()))};
}

}  // namespace crisp::report
