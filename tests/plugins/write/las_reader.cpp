// SPDX-License-Identifier: BSD-3-Clause
#include "tests/plugins/write/las_reader.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "tests/support/temporary_folder.hpp"

namespace crisp::test {
namespace {

template <class T>
T at(const std::string& bytes, std::size_t offset) {
  T value{};
  if (offset + sizeof(T) > bytes.size()) {
    ADD_FAILURE() << "the file ends at " << bytes.size() << ", before byte " << offset + sizeof(T);
    return value;
  }
  std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

/// Names of the extra fields, which must be of type 3, in the one record that describes them.
std::vector<std::string> extra_fields(const std::string& bytes, std::size_t record) {
  EXPECT_STREQ(bytes.substr(record + 2, 16).c_str(), "LASF_Spec");
  EXPECT_EQ(at<std::uint16_t>(bytes, record + 18), 4);  // extra bytes
  const std::size_t length = at<std::uint16_t>(bytes, record + 20);
  EXPECT_EQ(length % 192, 0U);
  EXPECT_EQ(at<std::uint32_t>(bytes, 96), record + 54 + length) << "where the points begin";
  std::vector<std::string> names;
  for (std::size_t i = 0; i < length / 192; ++i) {
    const std::size_t field = record + 54 + 192 * i;
    EXPECT_EQ(at<std::uint8_t>(bytes, field + 2), 3);
    names.emplace_back(bytes.substr(field + 4, 32).c_str());
  }
  return names;
}

}  // namespace

LasFile read_las(const std::filesystem::path& file) {
  const std::string bytes = bytes_of(file);
  EXPECT_EQ(bytes.substr(0, 4), "LASF");
  EXPECT_EQ(at<std::uint8_t>(bytes, 24), 1);
  EXPECT_EQ(at<std::uint8_t>(bytes, 25), 4);
  EXPECT_EQ(at<std::uint16_t>(bytes, 94), 375);
  EXPECT_EQ(at<std::uint8_t>(bytes, 104), 6);
  EXPECT_EQ(at<std::uint32_t>(bytes, 107), 0U) << "the older versions' count is 0 with point format 6";
  EXPECT_EQ(at<std::uint32_t>(bytes, 100), 1U);
  const auto flags = at<std::uint16_t>(bytes, 6);
  EXPECT_TRUE(flags & 16) << "point formats 6 to 10 need WKT";

  const auto names = extra_fields(bytes, 375);
  const std::size_t begin = at<std::uint32_t>(bytes, 96);
  const std::size_t step = at<std::uint16_t>(bytes, 105);
  const auto count = at<std::uint64_t>(bytes, 247);
  EXPECT_EQ(step, 30 + 2 * names.size());
  EXPECT_EQ(begin + step * count, bytes.size());
  EXPECT_EQ(at<std::uint64_t>(bytes, 255), count) << "of first returns";

  LasFile las{.has_standard_gps_time = (flags & 1) != 0};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    las.most[axis] = at<double>(bytes, 179 + 16 * axis);
    las.least[axis] = at<double>(bytes, 187 + 16 * axis);
  }
  const auto coordinate = [&](std::size_t point, std::size_t axis) {
    return at<std::int32_t>(bytes, point + 4 * axis) * at<double>(bytes, 131 + 8 * axis) +
           at<double>(bytes, 155 + 8 * axis);
  };
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t p = begin + step * i;
    LasPoint point{.x = coordinate(p, 0), .y = coordinate(p, 1), .z = coordinate(p, 2)};
    point.intensity = at<std::uint16_t>(bytes, p + 12);
    point.return_number = at<std::uint8_t>(bytes, p + 14) & 15;
    point.returns = at<std::uint8_t>(bytes, p + 14) >> 4;
    point.point_source = at<std::uint16_t>(bytes, p + 20);
    point.gps_time = at<double>(bytes, p + 22);
    for (std::size_t k = 0; k < names.size(); ++k)
      point.extra[names[k]] = at<std::uint16_t>(bytes, p + 30 + 2 * k);
    las.points.push_back(point);
  }
  return las;
}

}  // namespace crisp::test
