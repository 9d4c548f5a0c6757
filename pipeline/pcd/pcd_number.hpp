// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <crisp/pcd_table.hpp>

namespace crisp::pcd {

/// Calls visitor(T{}) with the type T that the field's elements have. The field is one that
/// parse_pcd_header() accepts.
template <class Visitor>
void visit_number(const PcdField& field, Visitor visitor) {
  const auto by_size = [&](auto one, auto two, auto four, auto eight) {
    if (field.size == 1) return visitor(one);
    if (field.size == 2) return visitor(two);
    if (field.size == 4) return visitor(four);
    return visitor(eight);
  };
  if (field.type == 'I') return by_size(std::int8_t{}, std::int16_t{}, std::int32_t{}, std::int64_t{});
  if (field.type == 'U') return by_size(std::uint8_t{}, std::uint16_t{}, std::uint32_t{}, std::uint64_t{});
  return field.size == 4 ? visitor(float{}) : visitor(double{});
}

}  // namespace crisp::pcd
