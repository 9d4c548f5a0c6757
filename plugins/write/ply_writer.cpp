// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/ply_writer.hpp"

#include <fmt/format.h>

namespace crisp::write {
namespace {

constexpr std::size_t kPlyPoint = 4 * sizeof(float) + 2 * sizeof(std::uint16_t) + sizeof(double);
constexpr std::size_t kPlyBuffer = 8192 * kPlyPoint;
constexpr std::size_t kLongestCount = 20;  // digits of 2^64

}  // namespace

PlyWriter::PlyWriter(const std::filesystem::path& file, std::uint64_t stamp, const Point&)
    : file_(file), stamp_(stamp), records_(kPlyBuffer) {
  file_.write(header());
}

/// The header's length is independent of the count: a comment fills the rest.
std::string PlyWriter::header() const {
  const std::string count = std::to_string(points_);
  return fmt::format(
      "ply\n"
      "format binary_little_endian 1.0\n"
      "comment crisp epoch_ns {}\n"
      "comment {}\n"
      "element vertex {}\n"
      "property float x\n"
      "property float y\n"
      "property float z\n"
      "property float intensity\n"
      "property ushort laser\n"
      "property ushort beam\n"
      "property double time\n"
      "end_header\n",
      1000 * stamp_, std::string(kLongestCount - count.size(), '-'), count);
}

void PlyWriter::add(const Point& point, std::size_t) {
  for (const float value : {point.x, point.y, point.z, point.intensity}) records_.put(value);
  records_.put(point.laser);
  records_.put(point.beam);
  records_.put(point.time);
  ++points_;
  if (records_.size() == kPlyBuffer) records_.flush(file_);
}

void PlyWriter::commit() {
  records_.flush(file_);
  file_.rewrite(0, header());
  file_.commit();
}

}  // namespace crisp::write
