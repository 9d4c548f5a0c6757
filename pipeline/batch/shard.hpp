// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace crisp::batch {

/// One part of a batch: each recording belongs to one of `count` parts by a hash of its name, so that adding
/// recordings moves none of the others.
struct Shard {
  std::uint64_t number = 1;  ///< from 1
  std::uint64_t count = 1;

  bool is_whole() const { return count == 1; }
  bool has(std::string_view name) const;
  std::string text() const;  ///< "3/64"
};

/// @throws Error if it is not "i/n" with 1 ≤ i ≤ n
Shard parse_shard(const std::string& text);

}  // namespace crisp::batch
