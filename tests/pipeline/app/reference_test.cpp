// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <set>

#include "pipeline/files/yaml.hpp"
#include "tests/support/source_dir.hpp"

namespace crisp {
namespace {

using namespace crisp::files;
namespace fs = std::filesystem;

/// The generated pages: the index, and those of stages, whose names have a dot ("filter.range.md").
std::set<std::string> pages_of(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const fs::path page = entry.path().filename();
    if (page == "README.md" || page.stem().has_extension()) names.insert(page.string());
  }
  return names;
}

TEST(Reference, DescribesTheDeclaredStages) {
  const fs::path written = fs::path(source_dir()) / "docs" / "reference";
  const fs::path fresh = fs::path(testing::TempDir()) / "crisp-reference";
  fs::remove_all(fresh);
  ASSERT_EQ(std::system((CRISP_PROGRAM " stages --markdown --output " + fresh.string()).c_str()), 0);
  const std::string cure =
      "run: crisp stages --markdown --output docs/reference (and remove pages of stages that are gone)";
  EXPECT_EQ(pages_of(written), pages_of(fresh)) << cure;
  constexpr std::size_t kLimit = 1 << 20;
  for (const auto& page : pages_of(fresh)) {
    if (!fs::exists(written / page)) continue;
    EXPECT_EQ(read_text_file(written / page, kLimit), read_text_file(fresh / page, kLimit))
        << page << ": " << cure;
  }
  fs::remove_all(fresh);
}

TEST(Reference, DescribesTheDeclaredEffects) {
  const fs::path written = fs::path(source_dir()) / "docs" / "effects.md";
  const fs::path fresh = fs::path(testing::TempDir()) / "crisp-effects.md";
  ASSERT_EQ(std::system((CRISP_PROGRAM " effects --markdown > " + fresh.string()).c_str()), 0);
  constexpr std::size_t kLimit = 1 << 20;
  EXPECT_EQ(read_text_file(written, kLimit), read_text_file(fresh, kLimit))
      << "run: crisp effects --markdown > docs/effects.md";
  fs::remove(fresh);
}

}  // namespace
}  // namespace crisp
