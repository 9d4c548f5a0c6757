// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <cstddef>

#include "grabbers/wire/bytes.hpp"

namespace crisp::capture {

enum class ByteOrder : std::uint8_t { Little, Big };

/// The unsigned number at `at`, which must lie within `bytes` with all of its width.
template <std::unsigned_integral T>
T number_at(wire::ByteView bytes, std::size_t at, ByteOrder order) {
  const auto* from = bytes.data() + at;
  std::uint64_t value = 0;
  if (order == ByteOrder::Big) {  // a loop for each, which compilers know as one load
    for (std::size_t i = 0; i < sizeof(T); ++i) value = (value << 8) | from[i];
  } else {
    for (std::size_t i = sizeof(T); i-- > 0;) value = (value << 8) | from[i];
  }
  return static_cast<T>(value);
}

/// The same in the order of the network.
template <std::unsigned_integral T>
T network_number(wire::ByteView bytes, std::size_t at) {
  return number_at<T>(bytes, at, ByteOrder::Big);
}

}  // namespace crisp::capture
