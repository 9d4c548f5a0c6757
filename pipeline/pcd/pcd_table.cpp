// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <limits>

#include <crisp/error.hpp>
#include <crisp/pcd_table.hpp>

#include "pipeline/data/internal_error.hpp"
#include "pipeline/files/sha256.hpp"
#include "pipeline/pcd/pcd_number.hpp"

namespace crisp {
namespace {

template <PcdNumber T, PcdNumber From>
T converted(From value, std::string_view field) {
  if constexpr (std::integral<T>) {
    // Every integer type's limits are exact in long double, so that nothing slips through by rounding.
    const auto wide = static_cast<long double>(value);
    const bool fits = wide >= static_cast<long double>(std::numeric_limits<T>::min()) &&
                      wide <= static_cast<long double>(std::numeric_limits<T>::max());
    if (!fits)
      throw Error(fmt::format("the field '{}' holds {}", field, value),
                  fmt::format("expected is a number from {} to {}", std::numeric_limits<T>::min(),
                              std::numeric_limits<T>::max()));
  }
  return static_cast<T>(value);
}

}  // namespace

PcdTable::PcdTable(PcdHeader header, std::string columns, std::size_t surplus)
    : header_(std::move(header)), columns_(std::move(columns)), surplus_(surplus) {
  if (columns_.size() != header_.points * header_.record_size()) {
    throw data::internal_error("the columns of a PCD table do not fit its header");
  }
}

std::string PcdTable::digest() const {
  constexpr std::size_t kDigits = 16;
  return files::sha256_of(columns_).substr(0, kDigits);
}

template <PcdNumber T>
std::vector<T> PcdTable::column(std::string_view name) const {
  std::size_t begin = 0;
  for (const auto& field : header_.fields) {
    if (field.name == name && field.count == 1) {
      std::vector<T> values(rows());
      pcd::visit_number(field, [&]<PcdNumber From>(From) {
        for (std::size_t row = 0; row < rows(); ++row) {
          From value;
          std::memcpy(&value, columns_.data() + begin + row * sizeof(From), sizeof(From));
          values[row] = converted<T>(value, name);
        }
      });
      return values;
    }
    begin += field.width() * rows();
  }
  std::string known;
  for (const auto& field : header_.fields) known += (known.empty() ? "" : ", ") + field.name;
  throw Error(fmt::format("there is no field '{}'", name), "the fields are: " + known);
}

template std::vector<float> PcdTable::column(std::string_view) const;
template std::vector<double> PcdTable::column(std::string_view) const;
template std::vector<std::uint16_t> PcdTable::column(std::string_view) const;

}  // namespace crisp
