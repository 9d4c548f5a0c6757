// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/data/exception_to_error.hpp"

#include <filesystem>
#include <new>
#include <system_error>

#include "pipeline/data/internal_error.hpp"

namespace crisp::data {

std::optional<Error> resource_exhaustion(const std::exception& thrown) {
  if (dynamic_cast<const std::bad_alloc*>(&thrown) != nullptr)
    return Error("the memory is exhausted", "give it less data at once, or end other programs");
  const auto* refused = dynamic_cast<const std::system_error*>(&thrown);
  if (refused != nullptr && refused->code() == std::errc::resource_unavailable_try_again)
    return Error("the system starts no further thread: it lacks memory, or too many processes run",
                 "end other programs, or raise `ulimit -u`");
  return std::nullopt;
}

Error error_of(const std::exception& thrown) {
  if (const auto* error = dynamic_cast<const Error*>(&thrown)) return *error;
  if (const auto* file = dynamic_cast<const std::filesystem::filesystem_error*>(&thrown))
    return Error(file->path1().string() + ": " + file->code().message(),
                 "check the path and its permissions");
  if (auto lack = resource_exhaustion(thrown)) return *lack;
  if (dynamic_cast<const std::system_error*>(&thrown) != nullptr)
    return Error(thrown.what(), "remove the cause that the system reports");
  return internal_error(thrown.what());
}

}  // namespace crisp::data
