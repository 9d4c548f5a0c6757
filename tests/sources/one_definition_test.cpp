// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "tests/sources/type_names.hpp"
#include "tests/support/source_dir.hpp"

namespace crisp::test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;

std::vector<std::string> names_in(std::string_view source) {
  std::vector<std::string> names;
  for (const auto& type : named_types(source)) names.push_back(type.name);
  return names;
}

TEST(TypeNames, AreThoseThatTheLinkerSees) {
  EXPECT_THAT(names_in(R"(
#include <x>  // struct InADirective {
namespace crisp {
struct Ahead;
/* struct InAComment { */
struct First { struct Inner {}; const char* text = "struct InText {"; };
template <class T> class alignas(16) Second final : public First { void f() { struct Local {}; } };
namespace { struct Hidden { int big = 1'000; }; }
enum class Third { a, b };
}
namespace crisp::simd { struct Fourth {}; }
)"),
              ElementsAre("crisp::First", "crisp::Second", "crisp::Third", "crisp::simd::Fourth"));
}

/// Two types of one name in one program: the linker takes one of each function that both have, and the other
/// type's objects are read as if they were the first's. No compiler and no linker reports it.
TEST(TypeNames, AreDefinedOnceInTheLibraries) {
  std::map<std::string, std::vector<std::string>> places;
  for (const char* folder : {"pipeline", "grabbers", "plugins"}) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(source_dir()) / folder)) {
      const auto kind = entry.path().extension();
      if (kind != ".cpp" && kind != ".hpp" && kind != ".cu") continue;
      std::ostringstream text;
      text << std::ifstream(entry.path()).rdbuf();
      for (const auto& type : named_types(text.str())) {
        places[type.name].push_back(
            fmt::format("{}:{}", entry.path().lexically_relative(source_dir()).string(), type.line));
      }
    }
  }
  ASSERT_GT(places.size(), 300U) << "the sources were not found";
  for (const auto& [name, where] : places) {
    EXPECT_EQ(where.size(), 1U) << name << " is defined at " << fmt::format("{}", fmt::join(where, ", "));
  }
}

}  // namespace
}  // namespace crisp::test
