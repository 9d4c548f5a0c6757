// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/data/resource_exhaustion.hpp"

#include <new>
#include <system_error>

namespace crisp {

std::optional<Error> resource_exhaustion(const std::exception& thrown) {
  if (dynamic_cast<const std::bad_alloc*>(&thrown) != nullptr)
    return Error("the memory is exhausted", "give it less data at once, or end other programs");
  const auto* refused = dynamic_cast<const std::system_error*>(&thrown);
  if (refused != nullptr && refused->code() == std::errc::resource_unavailable_try_again)
    return Error("the system starts no further thread: it lacks memory, or too many processes run",
                 "end other programs, or raise `ulimit -u`");
  return std::nullopt;
}

}  // namespace crisp
