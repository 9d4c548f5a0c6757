// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/report/run_content.hpp"

#include <fstream>
#include <optional>
#include <sstream>
#include <system_error>

#include "pipeline/files/utc_now.hpp"

namespace crisp::report {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::optional<std::string> text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return std::nullopt;
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::optional<ReportPlot> plot_of(const fs::path& written, const fs::path& folder) {
  if (written.extension() != ".svg") return std::nullopt;
  auto svg = text_of(folder.empty() ? written : folder / written.filename());
  if (!svg) svg = text_of(written);
  if (!svg) return std::nullopt;
  return ReportPlot{.name = written.stem().string(), .svg = std::move(*svg)};
}

/// The recording's name, with its folder's: the input that is neither pipeline nor rig; of several, the
/// folder.
std::string title_of(const Json& summary) {
  std::string title;
  for (const Json& input : summary.value("inputs", Json::array())) {
    const fs::path file = input.value("file", "");
    const auto kind = file.extension();
    if (kind == ".yaml" || kind == ".yml") continue;
    if (!title.empty()) return fs::path(file).parent_path().filename().string();
    title = (file.parent_path().filename() / file.filename()).string();
  }
  if (!title.empty()) return title;
  return fs::path(summary.value("pipeline", "crisp")).filename().string();
}

}  // namespace

PageContent run_content(const Json& summary, const fs::path& folder) {
  PageContent content{.title = title_of(summary), .data = {}, .plots = {}, .cloud = {}};
  content.data = {{"kind", "run"}, {"written", files::utc_now()}, {"summary", summary}};
  for (const Json& stage : summary.value("stages", Json::array())) {
    for (const Json& file : stage.value("outputs", Json::array())) {
      if (auto plot = plot_of(file.get<std::string>(), folder)) content.plots.push_back(std::move(*plot));
    }
  }
  return content;
}

}  // namespace crisp::report
