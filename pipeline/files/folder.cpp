// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/files/folder.hpp"

#include <algorithm>
#include <system_error>

#include "pipeline/data/error.hpp"

namespace crisp {

std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder) {
  std::error_code failure;
  std::vector<std::filesystem::path> files;
  std::filesystem::directory_iterator entry(folder, failure);
  for (; !failure && entry != std::filesystem::directory_iterator(); entry.increment(failure)) {
    std::error_code unknown;
    if (entry->is_regular_file(unknown)) files.push_back(entry->path());
  }
  if (failure) {
    throw Error(folder.string() + " cannot be read: " + failure.message(), "check its name and its rights");
  }
  std::ranges::sort(files);
  return files;
}

}  // namespace crisp
