// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string_view>
#include <typeinfo>

namespace pcl {
template <typename PointT>
class PointCloud;
}

namespace crisp {

struct Scan;
struct PlateReading;
struct ClockMap;
struct Measurements;
class PlateTrajectory;
struct Calibration;
struct Findings;
struct Point;

/// The name under which people know a kind of data. A plugin makes a type of its own flow by specialising it:
///
///     template <> struct crisp::KindName<Thing> { static constexpr std::string_view value = "Thing"; };
///
/// Only names are here: whoever takes or gives a kind includes the header that defines it.
template <class T>
struct KindName;

/// @cond
// clang-format off
template <> struct KindName<Scan> { static constexpr std::string_view value = "Scan"; };
template <> struct KindName<PlateReading> { static constexpr std::string_view value = "PlateReading"; };
template <> struct KindName<ClockMap> { static constexpr std::string_view value = "ClockMap"; };
template <> struct KindName<Measurements> { static constexpr std::string_view value = "Measurements"; };
template <> struct KindName<PlateTrajectory> { static constexpr std::string_view value = "PlateTrajectory"; };
template <> struct KindName<Calibration> { static constexpr std::string_view value = "Calibration"; };
template <> struct KindName<pcl::PointCloud<Point>> { static constexpr std::string_view value = "Cloud"; };
template <> struct KindName<Findings> { static constexpr std::string_view value = "Findings"; };
// clang-format on
/// @endcond

/// A kind of data that flows between stages: a C++ type and its name.
class Kind {
 public:
  template <class T>
  /// The kind of a C++ type. @tparam T  a type that KindName knows
  static Kind of() {
    return {KindName<T>::value, typeid(T)};
  }

  /// The name under which people know the kind: "Scan".
  std::string_view name() const { return name_; }
  /// Whether both are of the same C++ type.
  bool operator==(const Kind& other) const { return *type_ == *other.type_; }

 private:
  Kind(std::string_view name, const std::type_info& type) : name_(name), type_(&type) {}

  std::string_view name_;
  const std::type_info* type_;
};

/// One thing that flows, immutable once passed on.
struct Item {
  Kind kind;                          ///< of the value
  std::shared_ptr<const void> value;  ///< of the kind's C++ type

  template <class T>
  /// An item that holds a value of type T.
  static Item of(std::shared_ptr<const T> value) {
    return {Kind::of<T>(), std::move(value)};
  }
  template <class T>
  /// The value, or nullptr if it is of another kind.
  std::shared_ptr<const T> as() const {
    return kind == Kind::of<T>() ? std::static_pointer_cast<const T>(value) : nullptr;
  }
};

}  // namespace crisp
