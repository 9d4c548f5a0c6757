// SPDX-License-Identifier: BSD-3-Clause
// What is installed refers to nothing that is not. Whether each public header compiles alone, tests/installed
// tries.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

#include "tests/support/source_dir.hpp"

namespace crisp::test {
namespace {

namespace fs = std::filesystem;
using testing::IsEmpty;

const fs::path& public_folder() {
  static const fs::path kFolder = fs::path(source_dir()) / "pipeline/include";
  return kFolder;
}

/// Includes of a source that its users cannot follow: those of internal headers, and of public ones that are
/// not there.
/// @param own  folder whose headers it may include by their names alone; empty: none
std::vector<std::string> unusable_includes(const fs::path& source, const fs::path& own = {}) {
  static const std::regex kInclude(R"(^\s*#\s*include\s*([<"])([^">]+)[">].*)");
  std::vector<std::string> found;
  std::ifstream lines(source);
  std::string line;
  for (std::smatch match; std::getline(lines, line);) {
    if (!std::regex_match(line, match, kInclude)) continue;
    const std::string name = match[2];
    const bool is_quoted = match[1] == "\"";
    const bool is_own = !own.empty() && fs::exists(own / name);
    const bool is_missing = name.starts_with("crisp/") && !fs::exists(public_folder() / name);
    if ((is_quoted && !is_own) || is_missing) found.push_back(source.filename().string() + ": " + name);
  }
  return found;
}

std::vector<std::string> unusable_includes_in(const fs::path& folder, const fs::path& own = {}) {
  std::vector<std::string> found;
  std::size_t sources = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".hpp" && entry.path().extension() != ".cpp") continue;
    ++sources;
    for (auto& name : unusable_includes(entry.path(), own)) found.push_back(std::move(name));
  }
  EXPECT_GT(sources, 10U) << "the sources were not found in " << folder;
  return found;
}

TEST(PublicHeaders, IncludeNoInternalHeader) {
  EXPECT_THAT(unusable_includes_in(public_folder() / "crisp"), IsEmpty());
}

TEST(PublicHeaders, AreAllThatExamplesInclude) {
  const fs::path examples = fs::path(source_dir()) / "tests/examples";
  EXPECT_THAT(unusable_includes_in(examples, examples), IsEmpty());
}

TEST(PublicHeaders, AreNotThoseOfTheFolders) {
  EXPECT_THAT(unusable_includes(fs::path(source_dir()) / "pipeline/data/error.cpp"), IsEmpty());
  EXPECT_THAT(unusable_includes(fs::path(source_dir()) / "tests/sources/public_headers_test.cpp"),
              testing::ElementsAre("public_headers_test.cpp: tests/support/source_dir.hpp"));
}

}  // namespace
}  // namespace crisp::test
