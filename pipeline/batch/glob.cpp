// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/batch/glob.hpp"

#include <fnmatch.h>

#include <algorithm>
#include <iterator>
#include <system_error>

namespace crisp::batch {
namespace {

namespace fs = std::filesystem;
using Parts = std::vector<std::string>;

Parts parts_of(const fs::path& path) {
  Parts parts;
  for (const auto& part : path) {
    if (!part.empty()) parts.push_back(part.string());
  }
  return parts;
}

bool is_hidden(const fs::path& path) { return path.filename().string().starts_with("."); }

/// Entries of a readable folder; none for another, as in a shell.
std::vector<fs::path> entries_of(const fs::path& folder) {
  std::error_code failure;
  std::vector<fs::path> entries;
  fs::directory_iterator entry(folder.empty() ? fs::path(".") : folder, failure);
  for (; !failure && entry != fs::directory_iterator(); entry.increment(failure))
    entries.push_back(folder / entry->path().filename());
  return entries;
}

void match(const fs::path& at, Parts::const_iterator part, Parts::const_iterator end,
           std::vector<fs::path>& found) {
  std::error_code none;
  if (part == end) {
    if (fs::exists(at, none)) found.push_back(at);
    return;
  }
  if (!is_pattern(*part)) return match(at / *part, std::next(part), end, found);
  if (*part == "**") match(at, std::next(part), end, found);
  for (const auto& entry : entries_of(at)) {
    if (*part == "**") {
      const bool descends =
          !is_hidden(entry) && fs::is_directory(entry, none) && !fs::is_symlink(entry, none);
      if (descends) match(entry, part, end, found);
    } else if (fnmatch(part->c_str(), entry.filename().c_str(), FNM_PERIOD) == 0) {
      match(entry, std::next(part), end, found);
    }
  }
}

}  // namespace

bool is_pattern(const std::string& path) { return path.find_first_of("*?[") != std::string::npos; }

fs::path fixed_part(const std::string& pattern) {
  fs::path fixed;
  for (const auto& part : fs::path(pattern)) {
    if (is_pattern(part.string())) break;
    fixed /= part;
  }
  return fixed;
}

std::vector<fs::path> match_pattern(const std::string& pattern) {
  const fs::path fixed = fixed_part(pattern);
  const Parts parts = parts_of(fs::path(pattern).lexically_relative(fixed.empty() ? "." : fixed));
  std::vector<fs::path> found;
  match(fixed, parts.begin(), parts.end(), found);
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace crisp::batch
