// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/las_writer.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstring>

#include "plugins/write/gps_time.hpp"

namespace crisp::write {
namespace {

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

std::array<double, 3> position_of(const Point& point) { return {point.x, point.y, point.z}; }

}  // namespace

LasWriter::LasWriter(const std::filesystem::path& file, std::uint64_t stamp, const Point& first)
    : file_(file),
      stamp_(stamp),
      time_shift_(adjusted_gps_time(stamp).value_or(0)),
      grid_(grid_near(position_of(first))),
      records_(kLasBuffer) {
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
  for (std::size_t i = 0; i < 3; ++i) to.put(grid_.scale);
  for (const double value : grid_.offset) to.put(value);
  const auto least = grid_.numbers(extent_.least), most = grid_.numbers(extent_.most);
  for (std::size_t i = 0; i < 3; ++i) {
    to.put(points_ == 0 ? 0 : grid_.coordinate(i, (*most)[i]));
    to.put(points_ == 0 ? 0 : grid_.coordinate(i, (*least)[i]));
  }
  to.put_zeros(sizeof(std::uint64_t));                          // waveforms
  to.put_zeros(sizeof(std::uint64_t) + sizeof(std::uint32_t));  // records behind the points
  to.put(points_);
  to.put(points_);  // of first returns
  to.put_zeros(14 * sizeof(std::uint64_t));
  put_extra_fields(to);
  return std::string(to.view());
}

/// Makes room for a point beyond the grid's reach. @return whether there is some
bool LasWriter::widen(const std::array<double, 3>& position) {
  Extent extent = points_ == 0 ? Extent::of(position) : extent_;
  extent.include(position);
  const auto wider = wider_grid(grid_, extent);
  if (!wider) return false;
  move_records(*wider);
  grid_ = *wider;
  return true;
}

/// Writes the coordinates of all points so far anew.
void LasWriter::move_records(const LasGrid& to) {
  records_.flush(file_);
  std::string records;
  const std::uint64_t end = kPointsBegin + points_ * kPointSize;
  for (std::uint64_t at = kPointsBegin; at < end; at += records.size()) {
    records.resize(std::min<std::uint64_t>(kLasBuffer, end - at));
    file_.read(static_cast<long>(at), records);
    for (std::size_t record = 0; record < records.size(); record += kPointSize) {
      std::array<std::int32_t, 3> numbers{};
      std::memcpy(numbers.data(), records.data() + record, sizeof(numbers));
      std::array<double, 3> position{};
      for (std::size_t i = 0; i < position.size(); ++i) position[i] = grid_.coordinate(i, numbers[i]);
      numbers = to.numbers(position).value();
      std::memcpy(records.data() + record, numbers.data(), sizeof(numbers));
    }
    file_.rewrite(static_cast<long>(at), records);
  }
}

void LasWriter::add(const Point& point, std::size_t recording) {
  const auto position = position_of(point);
  auto numbers = grid_.numbers(position);
  if (!numbers && widen(position)) numbers = grid_.numbers(position);
  if (!numbers) {
    ++too_far_;
    return;
  }
  if (points_ == 0) extent_ = Extent::of(position);
  extent_.include(position);
  for (const std::int32_t number : *numbers) records_.put(number);
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
  return {{"points too far from the others for LAS", too_far_},
          {"intensities that LAS rounded or limited to 0 to 65535", rounded_intensities_}};
}

std::vector<std::string> LasWriter::warnings() const {
  constexpr double kFinest = 1e-4;  // [m]
  if (grid_.scale == kFinest) return {};
  return {fmt::format(
      "the cloud's points are so far apart that {} holds coordinates in steps of {:g} mm instead of 0.1 mm; remove points that are far off, or write the parts of the cloud as files of their own",
      file_.path().string(), 1e3 * grid_.scale)};
}

}  // namespace crisp::write
