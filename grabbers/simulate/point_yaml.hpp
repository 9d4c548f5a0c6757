// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "pipeline/files/yaml_map.hpp"

namespace crisp::simulate {

/// A list of two or three lengths [m]; those that are not given or wrong are 0, and the latter an error.
Eigen::Vector3d read_point(const files::YamlNode& node, const std::string& what, std::size_t dimensions,
                           std::vector<Error>& errors);

/// A list of such.
std::vector<Eigen::Vector3d> read_points(const files::YamlNode& node, const std::string& what,
                                         std::size_t dimensions, std::vector<Error>& errors);

/// The point under a key of a map; `fallback` where there is none.
Eigen::Vector3d read_vector(files::YamlMap& map, const std::string& key, const Eigen::Vector3d& fallback,
                            std::vector<Error>& errors);

/// The point under a key that must be there.
Eigen::Vector3d require_vector(files::YamlMap& map, const std::string& key, std::vector<Error>& errors);

/// The number under a key, in SI. One whose size is beyond `most` is an error: it is implausible, and a
/// world made of it would be none.
double read_bounded(files::YamlMap& map, const std::string& key, const std::string& unit, double fallback,
                    double most);

inline constexpr double kMaxLength = 1e5;  ///< [m] nothing stands farther off
inline constexpr double kMaxYaw = 1000;    ///< [rad]

}  // namespace crisp::simulate
