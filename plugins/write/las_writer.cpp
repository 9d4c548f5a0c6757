// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/las_writer.hpp"

#include <chrono>
#include <cmath>

#include "plugins/write/gps_time.hpp"

namespace crisp {
namespace {

constexpr double kScale = 1e-4;          // [m]
constexpr double kOffsetGrid = 100'000;  // [m] 0 for all but maps
constexpr std::uint16_t kHeaderSize = 375;
constexpr std::uint16_t kVlrHeaderSize = 54;
constexpr std::uint16_t kExtraBytesSize = 192;  // of one field's description
constexpr std::uint16_t kExtraFields = 2;
constexpr std::uint32_t kPointsBegin = kHeaderSize + kVlrHeaderSize + kExtraFields * kExtraBytesSize;
constexpr std::uint16_t kPointSize = 30 + kExtraFields * sizeof(std::uint16_t);
constexpr std::size_t kLasBuffer = 8192 * kPointSize;

/// Year and day of the year in the header: of the recording, so that the same cloud gives the same bytes.
void put_date(RecordBuffer& to, std::uint64_t unix_us) {
  using std::chrono::days;
  using std::chrono::floor;
  using std::chrono::January;
  using std::chrono::microseconds;
  using std::chrono::sys_days;
  using std::chrono::sys_time;
  using std::chrono::year_month_day;
  const auto today = floor<days>(sys_time<microseconds>(microseconds(static_cast<std::int64_t>(unix_us))));
  const year_month_day date(today);
  const auto of_year = today - sys_days(date.year() / January / 1) + days(1);
  to.put(static_cast<std::uint16_t>(of_year.count()));
  to.put(static_cast<std::uint16_t>(static_cast<int>(date.year())));
}

/// The description of an extra field of 16 bits without sign.
void put_extra_field(RecordBuffer& to, std::string_view name, std::string_view description) {
  constexpr std::uint8_t kUnsigned16 = 3;
  constexpr std::size_t kName = 32, kUnused = 4, kNumbers = 5 * 3 * sizeof(double);
  to.put_zeros(2);
  to.put(kUnsigned16);
  to.put(std::uint8_t{0});  // no smallest, no largest, no scale
  to.put_text(name, kName);
  to.put_zeros(kUnused + kNumbers);
  to.put_text(description, kName);
}

/// The variable length record that describes the extra fields.
void put_extra_fields(RecordBuffer& to) {
  constexpr std::uint16_t kExtraBytes = 4;
  constexpr std::size_t kUser = 16, kDescription = 32;
  to.put(std::uint16_t{0});
  to.put_text("LASF_Spec", kUser);
  to.put(kExtraBytes);
  to.put(static_cast<std::uint16_t>(kExtraFields * kExtraBytesSize));
  to.put_text("extra bytes", kDescription);
  put_extra_field(to, "laser", "index of the laser in the rig");
  put_extra_field(to, "beam", "index of the beam in its scan");
}

/// A number of tenths of a millimetre; nothing beyond 32 bits.
bool to_steps(double metres, std::int32_t& steps) {
  const double rounded = std::round(metres / kScale);
  constexpr double kMax = std::numeric_limits<std::int32_t>::max();
  if (std::abs(rounded) > kMax) return false;
  steps = static_cast<std::int32_t>(rounded);
  return true;
}

}  // namespace

LasWriter::LasWriter(const std::filesystem::path& file, std::uint64_t stamp, const Point& first)
    : file_(file), stamp_(stamp), time_shift_(adjusted_gps_time(stamp).value_or(0)), records_(kLasBuffer) {
  const std::array position = {first.x, first.y, first.z};
  for (std::size_t i = 0; i < position.size(); ++i)
    offset_[i] = kOffsetGrid * std::round(static_cast<double>(position[i]) / kOffsetGrid);
  least_.fill(std::numeric_limits<std::int32_t>::max());
  most_.fill(std::numeric_limits<std::int32_t>::min());
  file_.write(header());
}

std::string LasWriter::header() const {
  constexpr std::uint16_t kGpsStandardTime = 1, kWktBit = 1 << 4;  // the latter with point formats 6 to 10
  constexpr std::size_t kId = 16, kText = 32;
  RecordBuffer to(kPointsBegin);
  to.put_text("LASF", 4);
  to.put(std::uint16_t{0});
  to.put(static_cast<std::uint16_t>(kWktBit | (adjusted_gps_time(stamp_) ? kGpsStandardTime : 0)));
  to.put_zeros(kId);
  to.put(std::uint8_t{1});
  to.put(std::uint8_t{4});
  to.put_text("EXTRACTION", kText);
  to.put_text("crisp", kText);
  put_date(to, stamp_);
  to.put(kHeaderSize);
  to.put(kPointsBegin);
  to.put(std::uint32_t{1});  // variable length records
  to.put(std::uint8_t{6});   // point format
  to.put(kPointSize);
  to.put_zeros(6 * sizeof(std::uint32_t));  // counts of older versions
  for (std::size_t i = 0; i < 3; ++i) to.put(kScale);
  for (const double value : offset_) to.put(value);
  for (std::size_t i = 0; i < 3; ++i) {
    to.put(points_ == 0 ? 0 : offset_[i] + kScale * most_[i]);
    to.put(points_ == 0 ? 0 : offset_[i] + kScale * least_[i]);
  }
  to.put_zeros(sizeof(std::uint64_t));                          // waveforms
  to.put_zeros(sizeof(std::uint64_t) + sizeof(std::uint32_t));  // records behind the points
  to.put(points_);
  to.put(points_);  // of first returns
  to.put_zeros(14 * sizeof(std::uint64_t));
  put_extra_fields(to);
  return std::string(to.view());
}

void LasWriter::add(const Point& point, std::size_t recording) {
  std::array<std::int32_t, 3> steps{};
  if (!to_steps(point.x - offset_[0], steps[0]) || !to_steps(point.y - offset_[1], steps[1]) ||
      !to_steps(point.z - offset_[2], steps[2])) {
    ++too_far_;
    return;
  }
  for (std::size_t i = 0; i < steps.size(); ++i) {
    least_[i] = std::min(least_[i], steps[i]);
    most_[i] = std::max(most_[i], steps[i]);
    records_.put(steps[i]);
  }
  constexpr float kBrightest = std::numeric_limits<std::uint16_t>::max();
  constexpr std::uint8_t kOneOfOne = 1 | 1 << 4;  // return 1 of 1
  const float intensity =
      point.intensity > 0 ? std::min(std::round(point.intensity), kBrightest) : 0;  // NaN is 0, too
  rounded_intensities_ += intensity != point.intensity;
  records_.put(static_cast<std::uint16_t>(intensity));
  records_.put(kOneOfOne);
  records_.put_zeros(5);  // flags, classification, user data, scan angle
  records_.put(static_cast<std::uint16_t>(recording + 1));
  records_.put(time_shift_ + point.time);
  records_.put(point.laser);
  records_.put(point.beam);
  ++points_;
  if (records_.size() == kLasBuffer) records_.flush(file_);
}

void LasWriter::commit() {
  records_.flush(file_);
  file_.rewrite(0, header());
  file_.commit();
}

std::map<std::string, std::uint64_t> LasWriter::losses() const {
  return {{"points more than 214 km from the LAS file's offset", too_far_},
          {"intensities that LAS rounded or limited to 0 to 65535", rounded_intensities_}};
}

}  // namespace crisp
