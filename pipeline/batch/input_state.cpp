// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/batch/input_state.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <crisp/error.hpp>

#include "pipeline/batch/output_name.hpp"
#include "pipeline/files/list_files.hpp"
#include "pipeline/files/sha256.hpp"

namespace crisp::batch {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> paths_of(const BatchInput& input, const fs::path& rig) {
  std::vector<fs::path> paths;
  if (input.is_folder)
    paths = files::list_files(input.path);
  else
    paths = {input.path};
  std::erase_if(paths, [](const fs::path& path) { return path.filename().string().starts_with("."); });
  if (!rig.empty()) paths.push_back(rig);
  return paths;
}

InputFile state_of(const fs::path& path) {
  struct stat now {};
  if (stat(path.c_str(), &now) != 0)
    throw Error("cannot read " + path.string() + ": " + std::strerror(errno),
                "check its name and its permissions");
  constexpr std::int64_t kNanoseconds = 1'000'000'000;
  return {.file = output_name(path.filename().string()),
          .bytes = static_cast<std::uint64_t>(now.st_size),
          .mtime = now.st_mtim.tv_sec * kNanoseconds + now.st_mtim.tv_nsec};
}

}  // namespace

std::vector<InputFile> input_files(const BatchInput& input, const fs::path& rig) {
  if (!input.unreadable.empty())
    throw Error(input.path + ": " + input.unreadable, "check its name and its permissions");
  std::vector<InputFile> files;
  for (const auto& path : paths_of(input, rig)) files.push_back(state_of(path));
  return files;
}

bool is_untouched(const std::vector<InputFile>& before, const std::vector<InputFile>& now) {
  return std::ranges::equal(before, now, [](const InputFile& a, const InputFile& b) {
    return a.file == b.file && a.bytes == b.bytes && a.mtime == b.mtime;
  });
}

bool has_same_content(const std::vector<InputFile>& before, const std::vector<InputFile>& now,
                      const BatchInput& input, const fs::path& rig) {
  const bool may_be = std::ranges::equal(before, now, [](const InputFile& a, const InputFile& b) {
    return a.file == b.file && a.bytes == b.bytes && (a.mtime == b.mtime || !a.sha256.empty());
  });
  if (!may_be) return false;
  const auto paths = paths_of(input, rig);
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (before[i].mtime != now[i].mtime && files::digest_of(paths[i]).sha256 != before[i].sha256)
      return false;
  }
  return true;
}

}  // namespace crisp::batch
