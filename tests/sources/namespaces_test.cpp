// SPDX-License-Identifier: BSD-3-Clause
// What no public header declares is in the namespace of its folder.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>

#include "tests/support/source_dir.hpp"

namespace crisp::test {
namespace {

namespace fs = std::filesystem;

/// "crisp::estimate" for "pipeline/estimate/sample.hpp". Two folders' names are taken, by PCL and by
/// pipeline/pcd.
std::string namespace_of(const std::string& file) {
  static const std::regex kFolder(R"(\w+/(\w+)/.*)");
  const bool is_taken = file.starts_with("pipeline/pcl/") || file.starts_with("grabbers/pcd/");
  return std::regex_replace(file, kFolder, is_taken ? "crisp::$1_grabber" : "crisp::$1");
}

/// A source may open `crisp` alone: it defines what a public header declares.
void expect_own_namespace(const std::string& file) {
  static const std::regex kOpened(R"(\nnamespace (crisp[\w:]*) \{)");
  std::ifstream in(fs::path(source_dir()) / file);
  const std::string text(std::istreambuf_iterator<char>(in), {});
  const std::string own = namespace_of(file);
  bool is_opened = text.find("\nnamespace crisp") == std::string::npos ||
                   (!file.ends_with(".hpp") && text.find("#include <crisp/") != std::string::npos);
  for (std::sregex_iterator found(text.begin(), text.end(), kOpened), end; found != end; ++found) {
    const std::string name = (*found)[1];
    const bool is_own = name == own || name.starts_with("crisp::simd");
    is_opened |= is_own;
    EXPECT_TRUE(is_own || name == "crisp") << file << " opens " << name << " instead of " << own;
  }
  EXPECT_TRUE(is_opened) << file << " does not open " << own;
}

TEST(Namespaces, AreThoseOfTheFolders) {
  std::size_t sources = 0;
  for (const char* house : {"pipeline", "grabbers", "plugins"}) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(source_dir()) / house)) {
      const auto file = entry.path().lexically_relative(source_dir()).string();
      const auto kind = entry.path().extension();
      const bool is_source = kind == ".hpp" || kind == ".cpp" || kind == ".cu";
      if (!is_source || file.starts_with("pipeline/include/")) continue;
      expect_own_namespace(file);
      ++sources;
    }
  }
  ASSERT_GT(sources, 300U) << "the sources were not found";
}

}  // namespace
}  // namespace crisp::test
