// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/bag/exact_reader.hpp"

#include <algorithm>
#include <limits>

namespace crisp::bag {

bool ExactReader::read(std::uint64_t n, std::string& to) {
  constexpr std::uint64_t kAtOnce = 1 << 24;
  to.clear();
  while (to.size() < n) {
    const auto step = static_cast<std::size_t>(std::min<std::uint64_t>(n - to.size(), kAtOnce));
    const std::size_t had = to.size();
    to.resize(had + step);
    in_.read(to.data() + had, static_cast<std::streamsize>(step));
    if (static_cast<std::size_t>(in_.gcount()) != step) return false;
  }
  return true;
}

bool ExactReader::skip(std::uint64_t n) {
  constexpr auto kMax = static_cast<std::uint64_t>(std::numeric_limits<std::streamsize>::max() - 1);
  if (n > kMax) return false;
  in_.ignore(static_cast<std::streamsize>(n));
  return static_cast<std::uint64_t>(in_.gcount()) == n;
}

}  // namespace crisp::bag
