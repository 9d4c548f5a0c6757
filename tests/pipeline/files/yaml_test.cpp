// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/files/yaml.hpp"

#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>

#include "tests/pipeline/files/errors_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::files;
using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

std::vector<std::string> errors_of_yaml(const std::string& text) {
  return errors_of([&] { parse_yaml(text, "f.yaml"); });
}

TEST(Yaml, KeepsTheTextOfScalarsAndTheirPlace) {
  const auto root = parse_yaml("a: 010\nlist:\n  - \"5\"\n  - true\nnone:\n", "f.yaml");
  ASSERT_EQ(root.kind, YamlNode::Kind::map);
  EXPECT_EQ(root.find("a")->text, "010");
  EXPECT_EQ(to_string(root.find("a")->place), "f.yaml:1:4");
  const auto& list = root.find("list")->items;
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[0].text, "5");
  EXPECT_TRUE(list[0].quoted);
  EXPECT_FALSE(list[1].quoted);
  EXPECT_EQ(to_string(list[1].place), "f.yaml:4:5");
  EXPECT_EQ(root.find("none")->kind, YamlNode::Kind::null);
  EXPECT_EQ(root.find("nothing"), nullptr);
}

TEST(Yaml, TakesVariablesInFlowMapsAndKeepsColumnsRight) {
  const auto root = parse_yaml("with: {file: ${input}, to: [${output}/a.pcd, b], x: 1}", "f.yaml");
  const auto* with = root.find("with");
  EXPECT_EQ(with->find("file")->text, "${input}");
  EXPECT_EQ(with->find("to")->items[0].text, "${output}/a.pcd");
  EXPECT_EQ(to_string(with->find("x")->place), "f.yaml:1:53");
}

TEST(Yaml, FindsEveryKeyThatIsGivenTwice) {
  EXPECT_THAT(errors_of_yaml("a: 1\nb: {c: 1, c: 2}\na: 3\n"),
              ElementsAre("f.yaml:2:11: error: 'c' is given twice; the first is in line 2",
                          "f.yaml:3:1: error: 'a' is given twice; the first is in line 1"));
}

TEST(Yaml, StopsReportingAfterAHundredMistakes) {
  std::string text;
  for (int i = 0; i < 100000; ++i) text += "a: 1\n";
  EXPECT_EQ(errors_of_yaml(text).size(), 100u);
}

TEST(Yaml, StopsReportingAfterAHundredAliases) {
  std::string text = "a: &x 1\nb: [";
  for (int i = 0; i < 100000; ++i) text += "*x,";
  EXPECT_EQ(errors_of_yaml(text + "]\n").size(), 100u);
}

TEST(Yaml, RefusesWhatCouldReferToSomethingElse) {
  EXPECT_THAT(errors_of_yaml("a: &x 1\nb: *x\n"),
              ElementsAre(HasSubstr("f.yaml:1:4: error: anchors"), HasSubstr("f.yaml:2:4: error: aliases")));
  EXPECT_THAT(errors_of_yaml("a: !!python/object x\n"), ElementsAre(HasSubstr("tags (")));
  EXPECT_THAT(errors_of_yaml("{a: 1}: b\n"), ElementsAre(HasSubstr("a key must be a name, not a map")));
  EXPECT_THAT(errors_of_yaml("a: 1\n---\nb: 2\n"), ElementsAre(HasSubstr("more than one document")));
}

TEST(Yaml, ReportsWhereATextIsNotYaml) {
  EXPECT_THAT(
      errors_of_yaml("a: [1, 2\nb: 3\n"),
      ElementsAre(AllOf(
          StartsWith("f.yaml:2:2: error: this is not YAML"),
          EndsWith(
              "; the mistake may be on a line before it: check for a bracket or a quotation mark that is not closed, or a missing colon"))));
  EXPECT_THAT(errors_of_yaml("[1, 2"), ElementsAre(HasSubstr("; check for a bracket or a quotation mark")));
  EXPECT_THAT(errors_of_yaml("a: \"open\n"), ElementsAre(StartsWith("f.yaml:")));
  EXPECT_THAT(errors_of_yaml(std::string("a: b\n\0c", 7)),
              ElementsAre("f.yaml:2:1: error: there is a control character (0x00); is this a text file?"));
}

TEST(Yaml, ReportsWhichLineIsIndentedByATab) {
  EXPECT_THAT(
      errors_of_yaml("a: 1\nb:\n\t- c\n"),
      ElementsAre("f.yaml:3:1: error: a tab indents this line, which YAML does not allow; indent by blanks"));
  EXPECT_THAT(errors_of_yaml("a: 1\nb:\n  c: 1\n \td: 2\n"),
              ElementsAre(StartsWith("f.yaml:4:1: error: a tab")));
  EXPECT_EQ(parse_yaml("a:\t1\t# not before the text\n", "f.yaml").find("a")->text, "1");
}

TEST(Yaml, RefusesDepthThatCouldExhaustTheStack) {
  for (const std::string bracket : {"[", "{", "- ", "? ", "a: [", "{a: "}) {
    std::string deep;
    for (int i = 0; i < 100000; ++i) deep += bracket;
    EXPECT_EQ(errors_of_yaml(deep).size(), 1u) << bracket;
  }
}

TEST(Yaml, ReadsAnEmptyFileAsNothing) {
  EXPECT_EQ(parse_yaml("", "f.yaml").kind, YamlNode::Kind::null);
  EXPECT_EQ(parse_yaml("# only a comment\n", "f.yaml").kind, YamlNode::Kind::null);
  EXPECT_EQ(to_string(parse_yaml("", "f.yaml").place), "f.yaml:1:1") << "where readers report missing keys";
}

TEST(Yaml, ReportsWhyAFileCannotBeRead) {
  const auto message = [](const std::filesystem::path& file) -> std::string {
    try {
      read_yaml(file);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message("/nowhere/x.yaml"),
            "cannot read /nowhere/x.yaml: No such file or directory; check its name and its permissions");
  const test::TemporaryFolder folder;
  std::ofstream(folder / "empty.yaml") << "# only a comment\n";
  EXPECT_EQ(message(folder / "empty.yaml"),
            (folder / "empty.yaml").string() + ": error: the file is empty; write it, or name another file");
  EXPECT_EQ(message("/tmp"), "cannot read /tmp: it is a folder; name a file in it");
}

}  // namespace
}  // namespace crisp
