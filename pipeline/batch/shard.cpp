// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/batch/shard.hpp"

#include <fmt/format.h>

#include <charconv>
#include <optional>

#include <crisp/error.hpp>

namespace crisp::batch {
namespace {

/// FNV-1a, 64 bits (Fowler, Noll, Vo), with the finalizer of MurmurHash3, since remainders use the low bits.
std::uint64_t hash_of(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  hash = (hash ^ (hash >> 33)) * 0xff51afd7ed558ccd;
  hash = (hash ^ (hash >> 33)) * 0xc4ceb9fe1a85ec53;
  return hash ^ (hash >> 33);
}

std::optional<std::uint64_t> whole(std::string_view text) {
  std::uint64_t number = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (failure != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

}  // namespace

bool Shard::has(std::string_view name) const { return hash_of(name) % count == number - 1; }

std::string Shard::text() const { return fmt::format("{}/{}", number, count); }

Shard parse_shard(const std::string& text) {
  const std::size_t slash = text.find('/');
  if (slash != std::string::npos) {
    const auto number = whole(std::string_view(text).substr(0, slash));
    const auto count = whole(std::string_view(text).substr(slash + 1));
    if (number && count && *number >= 1 && *number <= *count) return {*number, *count};
  }
  throw Error("--shard: '" + text + "' is no part of a batch", "write the third of 64 as 3/64");
}

}  // namespace crisp::batch
