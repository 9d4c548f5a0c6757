// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/pcd/lzf.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace crisp::pcd {
namespace {

// The format: a byte below 32 announces that many literal bytes and one more; any other, with one or two
// bytes behind it, a repetition of what stood up to 8 KiB before.
constexpr std::size_t kLongestLiteral = 32;
constexpr std::size_t kShortestMatch = 3;
constexpr std::size_t kLongestMatch = 264;
constexpr std::size_t kFarthest = 8192;
constexpr std::size_t kLongForm = 7;
constexpr unsigned kHashBits = 14;

std::uint32_t hash_of(const unsigned char* at) {
  const std::uint32_t three = (std::uint32_t{at[0]} << 16) | (std::uint32_t{at[1]} << 8) | at[2];
  return (three * 2654435761U) >> (32 - kHashBits);
}

void put_literals(std::string& out, std::string_view bytes) {
  while (!bytes.empty()) {
    const std::size_t n = std::min(bytes.size(), kLongestLiteral);
    out.push_back(static_cast<char>(n - 1));
    out.append(bytes.substr(0, n));
    bytes.remove_prefix(n);
  }
}

void put_match(std::string& out, std::size_t length, std::size_t distance) {
  const std::size_t extent = length - 2;
  const std::size_t offset = distance - 1;
  out.push_back(static_cast<char>((std::min(extent, kLongForm) << 5) | (offset >> 8)));
  if (extent >= kLongForm) out.push_back(static_cast<char>(extent - kLongForm));
  out.push_back(static_cast<char>(offset & 0xff));
}

}  // namespace

std::string compress_lzf(std::string_view bytes) {
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  std::vector<std::size_t> seen(std::size_t{1} << kHashBits, 0);  // by hash: position + 1 of the latest three
  std::string out;
  out.reserve(bytes.size() + bytes.size() / kLongestLiteral + 1);  // nothing is longer, compressed
  std::size_t literals = 0;  // where those begin that are not yet put out
  std::size_t at = 0;
  while (at + kShortestMatch <= bytes.size()) {
    std::size_t& latest = seen[hash_of(data + at)];
    const std::size_t before = latest;
    latest = at + 1;
    const std::size_t distance = at + 1 - before;
    if (before == 0 || distance > kFarthest ||
        !std::equal(data + at, data + at + kShortestMatch, data + before - 1)) {
      ++at;
      continue;
    }
    const std::size_t most = std::min(kLongestMatch, bytes.size() - at);
    const auto end =
        std::mismatch(data + at + kShortestMatch, data + at + most, data + before - 1 + kShortestMatch);
    const auto length = static_cast<std::size_t>(end.first - (data + at));
    put_literals(out, bytes.substr(literals, at - literals));
    put_match(out, length, distance);
    at += length;
    literals = at;
  }
  put_literals(out, bytes.substr(literals));
  return out;
}

}  // namespace crisp::pcd
