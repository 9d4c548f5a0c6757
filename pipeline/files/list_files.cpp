// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/files/list_files.hpp"

#include <algorithm>
#include <cctype>
#include <system_error>

#include <crisp/error.hpp>

namespace crisp::files {

std::vector<std::filesystem::path> list_files(const std::filesystem::path& folder) {
  std::error_code failure;
  std::vector<std::filesystem::path> files;
  std::filesystem::directory_iterator entry(folder, failure);
  for (; !failure && entry != std::filesystem::directory_iterator(); entry.increment(failure)) {
    std::error_code unknown;
    if (entry->is_regular_file(unknown)) files.push_back(entry->path());
  }
  if (failure) {
    throw Error(folder.string() + " cannot be read: " + failure.message(),
                "check its name and its permissions");
  }
  std::ranges::sort(files);
  return files;
}

bool has_extension(const std::filesystem::path& file, const std::vector<std::string>& extensions) {
  std::string own = file.extension().string();
  std::ranges::transform(own, own.begin(), [](unsigned char c) { return std::tolower(c); });
  own.erase(own.find_last_not_of("0123456789") + 1);
  return std::ranges::find(extensions, own) != extensions.end();
}

}  // namespace crisp::files
