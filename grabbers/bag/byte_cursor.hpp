// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace crisp::bag {

static_assert(std::endian::native == std::endian::little, "bags are read on little-endian machines");

/// Bytes end before what they should hold does, or hold what cannot be: what was being read is damaged.
struct BagDamage {
  const char* what;
};

/// Reads little-endian numbers and texts from the front of bytes. Each throws BagDamage where they end
/// before.
class ByteCursor {
 public:
  /// @param damage  reported where the bytes end before their content
  explicit ByteCursor(std::string_view bytes, BagDamage damage = {"records that end before their content"})
      : rest_(bytes), damage_(damage) {}

  template <class T>
  T take() {
    T value{};
    std::memcpy(&value, bytes(sizeof(T)).data(), sizeof(T));
    return value;
  }
  std::string_view bytes(std::uint64_t n) {
    if (n > rest_.size()) throw damage_;
    const std::string_view taken = rest_.substr(0, n);
    rest_.remove_prefix(n);
    return taken;
  }
  /// After its length in 32 bits.
  std::string_view text() { return bytes(take<std::uint32_t>()); }

  bool empty() const { return rest_.empty(); }
  std::size_t size() const { return rest_.size(); }  ///< [bytes] that are left

 private:
  std::string_view rest_;
  BagDamage damage_;
};

}  // namespace crisp::bag
