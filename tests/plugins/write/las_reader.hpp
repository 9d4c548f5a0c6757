// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace crisp::test {

struct LasPoint {
  double x = 0, y = 0, z = 0;  ///< [m]
  int intensity = 0;
  int return_number = 0, returns = 0;
  int point_source = 0;
  double gps_time = 0;
  std::map<std::string, int> extra;  ///< of 16 bits without sign
};

struct LasFile {
  bool has_standard_gps_time = false;
  std::array<double, 3> least{}, most{};  ///< [m] by the header
  std::vector<LasPoint> points;
};

/// Reads LAS 1.4 with points of format 6, after the ASPRS' specification 1.4 R15. Fails the test that calls
/// it where a field has a value that the specification does not allow.
LasFile read_las(const std::filesystem::path& file);

}  // namespace crisp::test
