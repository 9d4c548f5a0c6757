// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/table/table_reader.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include "grabbers/table/decimal.hpp"

namespace crisp::table {
namespace {

constexpr std::size_t kMaxRanges = 65536;  // beams that a measurement's index can number
constexpr double kLargestAngle = 1e6;      // [rad]
constexpr double kLargestRange = 1e5;      // [m]

bool separates(char c) { return c == ',' || c == ';' || c == '\t' || c == ' '; }

/// A fault of a row, with its position in the row.
struct Fault {
  const char* what;
  std::size_t at;
};

/// The fields of a line. Spaces next to a comma belong to no field.
class Fields {
 public:
  explicit Fields(std::string_view text) {
    std::size_t at = 0;
    while (at < text.size()) {
      while (at < text.size() && text[at] == ' ') ++at;
      if (at == text.size()) break;
      const std::size_t begin = at;
      while (at < text.size() && !separates(text[at])) ++at;
      fields_.push_back(text.substr(begin, at - begin));
      starts_.push_back(begin);
      while (at < text.size() && text[at] == ' ') ++at;
      if (at < text.size() && separates(text[at])) ++at;
    }
    end_ = text.size();
  }

  std::size_t size() const { return fields_.size(); }
  std::size_t start(std::size_t i) const { return i < starts_.size() ? starts_[i] : end_; }

  /// Field of a column, which counts from 1. @throws Fault
  std::string_view text(std::size_t column) const {
    if (column < 1 || column > fields_.size()) throw Fault{"rows with too few columns", end_};
    return fields_[column - 1];
  }
  double number(std::size_t column) const {
    auto field = text(column);
    if (field.size() > 1 && field[0] == '+' && field[1] != '-') field.remove_prefix(1);
    double value = 0;
    const auto [end, failure] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (failure != std::errc() || end != field.data() + field.size()) {
      throw Fault{"rows with a field that is no number", start(column - 1)};
    }
    return value;
  }
  std::int64_t decimal(std::size_t column, int exponent) const {
    const auto value = shifted_decimal(text(column), exponent);
    if (!value) throw Fault{"rows with an impossible time or count", start(column - 1)};
    return *value;
  }

 private:
  std::vector<std::string_view> fields_;
  std::vector<std::size_t> starts_;
  std::size_t end_ = 0;
};

double metres(LengthUnit unit) {
  constexpr double kCentimetre = 0.01, kMillimetre = 0.001;
  if (unit == LengthUnit::m) return 1;
  return unit == LengthUnit::cm ? kCentimetre : kMillimetre;
}

/// @param rad  [rad] of one count of the encoder
double angle_of(const Fields& fields, int column, AngleUnit unit, double rad = 1) {
  if (unit == AngleUnit::deg) rad = std::numbers::pi / 180;
  if (unit == AngleUnit::rad) rad = 1;
  const double value = fields.number(static_cast<std::size_t>(column)) * rad;
  if (!(std::abs(value) <= kLargestAngle)) {
    throw Fault{"rows with an impossible angle", fields.start(static_cast<std::size_t>(column) - 1)};
  }
  return value;
}

std::size_t count_of(const Fields& fields, const TableFormat& format) {
  if (format.mirror_column) return 1;
  const auto first = static_cast<std::size_t>(*format.range_column);
  if (first > fields.size()) throw Fault{"rows with too few columns", fields.start(fields.size())};
  std::size_t left = fields.size() - first + 1;
  if (format.remission_column && *format.remission_column > *format.range_column) {
    left = std::min(left, static_cast<std::size_t>(*format.remission_column - *format.range_column));
  }
  if (format.count_column) {
    const auto counted = fields.decimal(static_cast<std::size_t>(*format.count_column), 0);
    if (counted < 0 || static_cast<std::size_t>(counted) > left) {
      throw Fault{"rows with fewer ranges than their count", fields.start(fields.size())};
    }
    left = static_cast<std::size_t>(counted);
  }
  if (left > kMaxRanges) throw Fault{"rows with more than 65536 ranges", fields.start(first - 1)};
  return left;
}

void read_ranges(const Fields& fields, const TableFormat& format, TableRow& row) {
  const std::size_t count = count_of(fields, format);
  const double unit = metres(format.range_unit);
  row.ranges.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    const auto column = static_cast<std::size_t>(*format.range_column) + k;
    const double raw = fields.text(column).empty() ? 0 : fields.number(column);  // nothing: no echo
    const bool code = !(raw > 0) || (format.invalid_from && raw >= *format.invalid_from);
    row.ranges.push_back(code || raw * unit > kLargestRange ? 0.0F : static_cast<float>(raw * unit));
    if (!format.remission_column) continue;
    const double remission = fields.number(static_cast<std::size_t>(*format.remission_column) + k);
    row.remissions.push_back(std::isfinite(remission) ? static_cast<float>(remission) : 0.0F);
  }
}

/// Position of the first decimal comma in a line whose numbers such as 0,5 are separated by other characters:
/// nothing if commas separate numbers, too, or points are decimal.
std::optional<std::size_t> decimal_comma(std::string_view line) {
  constexpr std::string_view kOthers = "; \t";
  const std::size_t begin = std::min(line.size(), line.find_first_not_of(kOthers));
  line = line.substr(0, line.find_last_not_of("; \t\r") + 1);  // what is outside parts nothing
  const auto is_digit = [&](std::size_t i) { return i < line.size() && line[i] >= '0' && line[i] <= '9'; };
  std::optional<std::size_t> first;
  bool parted = false, in_field = false;
  for (std::size_t i = begin; i < line.size(); ++i) {
    if (line[i] == '.') return {};
    if (kOthers.find(line[i]) != std::string_view::npos) {
      parted = true;
      in_field = false;
    } else if (line[i] == ',') {
      if (in_field || i == 0 || !is_digit(i - 1) || !is_digit(i + 1)) return {};
      in_field = true;
      if (!first) first = i;
    }
  }
  return parted ? first : std::nullopt;
}

}  // namespace

std::optional<TableRow> TableReader::parse(std::string_view text) {
  try {
    if (text.size() > TableLines::kLongest) throw Fault{"rows of more than 1 MiB", TableLines::kLongest};
    const Fields fields(text);
    const auto column = [](int number) { return static_cast<std::size_t>(number); };
    TableRow row;
    row.line = lines_.number();
    if (format_.time_column) {
      row.time_ns = fields.decimal(column(*format_.time_column), exponent_of(format_.time_unit));
    }
    if (format_.receipt_column) {
      row.receipt_ns = fields.decimal(column(*format_.receipt_column), exponent_of(format_.receipt_unit));
    }
    if (format_.counter_column) row.counter = fields.decimal(column(*format_.counter_column), 0);
    if (format_.laser_column) {
      const auto laser = fields.decimal(column(*format_.laser_column), 0);
      if (laser < 0 || laser >= static_cast<std::int64_t>(kMaxRanges)) {
        throw Fault{"rows of an impossible laser", fields.start(column(*format_.laser_column) - 1)};
      }
      row.laser = static_cast<std::uint16_t>(laser);
    }
    const AngleUnit unit = format_.angle_unit;
    if (format_.angle_column) {
      row.angle = angle_of(fields, *format_.angle_column, unit, format_.angle_per_count);
    }
    if (format_.mirror_column) {
      row.mirror =
          angle_of(fields, *format_.mirror_column, unit == AngleUnit::counts ? AngleUnit::rad : unit);
    }
    if (format_.range_column) read_ranges(fields, format_, row);
    return row;
  } catch (const Fault& fault) {
    ++losses_[fault.what];
    if (!first_fault_) {
      constexpr std::size_t kFarthest = 1'000'000'000;
      first_fault_.emplace(
          fault.what, "", Place{name_, lines_.number(), static_cast<int>(std::min(fault.at, kFarthest)) + 1});
    }
    return std::nullopt;
  }
}

std::optional<TableRow> TableReader::next() {
  std::string text;
  while (lines_.next(text)) {
    const auto begin = text.find_first_not_of(" \t");
    if (begin == std::string::npos || text[begin] == '#' || text[begin] == '%') continue;
    // names of columns: the first line, and it begins with a letter or a quote
    if (lines_.number() == 1 && (std::isalpha(static_cast<unsigned char>(text[begin])) || text[begin] == '"'))
      continue;
    if (const auto comma = decimal_comma(text)) {
      throw Error("the numbers have decimal commas, and here a comma separates two numbers",
                  "write them with points, and with one kind of separator: 0.5;1.25",
                  Place{name_, lines_.number(), static_cast<int>(*comma) + 1});
    }
    if (auto row = parse(text)) {
      ++rows_;
      return row;
    }
  }
  return std::nullopt;
}

}  // namespace crisp::table
