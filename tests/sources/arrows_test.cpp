// SPDX-License-Identifier: BSD-3-Clause
// Which folder may include which.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/source_dir.hpp"

namespace crisp::test {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::IsEmpty;

/// The folders of the pipeline, from the ground up: each includes those before it only. The last ones are the
/// doors, which include whatever they open.
constexpr std::array<std::string_view, 14> kLayers = {"statistics", "data", "files", "clocks", "quality",
                                                      "model",      "pcd",  "stage", "plot",   "estimate",
                                                      "batch",      "app",  "pcl",   "python"};
constexpr std::string_view kFirstDoor = "pipeline/app";

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// The first two folders of a path below the sources: "plugins/clock".
std::string room_of(const fs::path& path) {
  auto part = path.begin();
  const fs::path house = *part++;
  return (house / *part).string();
}

std::vector<fs::path> files_below(const char* folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(source_dir()) / folder)) {
    if (entry.is_regular_file()) files.push_back(entry.path().lexically_relative(source_dir()));
  }
  return files;
}

std::vector<fs::path> all_files() {
  std::vector<fs::path> all;
  for (const char* folder : {"pipeline", "grabbers", "plugins"}) {
    for (auto& file : files_below(folder)) all.push_back(std::move(file));
  }
  return all;
}

/// The room of each library, by its target: {"crisp::clock", "plugins/clock"}.
std::map<std::string, std::string> rooms_of_targets() {
  static const std::regex kLibrary(R"(\ncrisp_library\((\w+))");
  std::map<std::string, std::string> rooms;
  for (const auto& file : all_files()) {
    if (file.filename() != "CMakeLists.txt") continue;
    const std::string text = "\n" + text_of(source_dir() / file);
    for (std::sregex_iterator found(text.begin(), text.end(), kLibrary), end; found != end; ++found) {
      rooms["crisp::" + (*found)[1].str()] = room_of(file);
    }
  }
  return rooms;
}

/// The room of each public header, by the target that its reference names.
std::map<std::string, std::string> rooms_of_public_headers() {
  static const std::regex kRow(R"(\n\| `<(crisp/\w+\.hpp)>` \| `(crisp::\w+)`)");
  const auto targets = rooms_of_targets();
  const std::string text = text_of(fs::path(source_dir()) / "docs/reference/cpp.md");
  std::map<std::string, std::string> rooms;
  for (std::sregex_iterator row(text.begin(), text.end(), kRow), end; row != end; ++row) {
    rooms[(*row)[1]] = targets.at((*row)[2]);
  }
  return rooms;
}

std::optional<std::size_t> layer_of(std::string_view room) {
  constexpr std::string_view kPipeline = "pipeline/";
  if (!room.starts_with(kPipeline)) return {};
  const auto* found = std::ranges::find(kLayers, room.substr(kPipeline.size()));
  EXPECT_NE(found, kLayers.end()) << room << " has no place among the layers of this test";
  return static_cast<std::size_t>(found - kLayers.begin());
}

bool is_door(std::string_view room) {
  const auto layer = layer_of(room);
  return layer && *layer >= *layer_of(kFirstDoor);
}

bool may_include(const std::string& from, const std::string& to) {
  if (from == to || is_door(from)) return true;
  if (const auto layer = layer_of(from)) return layer_of(to) && *layer_of(to) < *layer;
  if (layer_of(to)) return !is_door(to);
  if (from == "plugins/study")
    return to == "grabbers/simulate" || to == "plugins/calibrate" ||
           to == "plugins/diagnose";  // what it studies
  return from.starts_with("grabbers/") && to.starts_with("grabbers/");
}

/// The includes of a source that point upwards or to a neighbour.
std::vector<std::string> wrong_arrows(const fs::path& file, const std::string& from,
                                      const std::map<std::string, std::string>& public_headers) {
  static const std::regex kInclude(
      R"(^\s*#\s*include\s*[<"]((crisp|pipeline|grabbers|plugins)/[^">]+)[">].*)");
  std::vector<std::string> wrong;
  std::ifstream lines(source_dir() / file);
  std::string line;
  for (std::smatch match; std::getline(lines, line);) {
    if (!std::regex_match(line, match, kInclude)) continue;
    const std::string name = match[1];
    const std::string to = match[2] == "crisp" ? public_headers.at(name) : room_of(name);
    if (!may_include(from, to)) wrong.push_back(fmt::format("{}: {} of {}", file.string(), name, to));
  }
  return wrong;
}

TEST(Arrows, PointOneWay) {
  const auto public_headers = rooms_of_public_headers();
  std::vector<std::string> wrong;
  std::size_t sources = 0;
  for (const auto& file : all_files()) {
    const auto kind = file.extension();
    if (kind != ".cpp" && kind != ".hpp" && kind != ".cu") continue;
    ++sources;
    const bool is_public = file.string().starts_with("pipeline/include/");
    const std::string room =
        is_public ? public_headers.at("crisp/" + file.filename().string()) : room_of(file);
    for (auto& arrow : wrong_arrows(file, room, public_headers)) wrong.push_back(std::move(arrow));
  }
  ASSERT_GT(sources, 300U) << "the sources were not found";
  EXPECT_THAT(wrong, IsEmpty());
}

TEST(Arrows, LeadFromGrabbersToNoPlugin) {
  EXPECT_TRUE(may_include("grabbers/live", "pipeline/data"));
  EXPECT_FALSE(may_include("grabbers/live", "plugins/clock"));
  EXPECT_FALSE(may_include("plugins/clock", "plugins/assemble"));
  EXPECT_FALSE(may_include("pipeline/data", "pipeline/model"));
  EXPECT_FALSE(may_include("pipeline/estimate", "grabbers/wire"));
  EXPECT_FALSE(may_include("plugins/report", "pipeline/app"));
}

/// A public header is of the room whose library it belongs to, wherever it lies.
TEST(Arrows, FollowPublicHeadersToTheirLibraries) {
  const fs::path grabber = "pipeline/pcl/cloud_grabber.cpp";
  EXPECT_THAT(wrong_arrows(grabber, "pipeline/pcl", rooms_of_public_headers()), IsEmpty());
  EXPECT_THAT(wrong_arrows(grabber, "grabbers/live", rooms_of_public_headers()),
              Contains("pipeline/pcl/cloud_grabber.cpp: crisp/deskew.hpp of plugins/assemble"));
}

}  // namespace
}  // namespace crisp::test
