// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/parts_options.hpp"

#include <fmt/format.h>

namespace crisp::write {

void report_removed(const std::vector<std::filesystem::path>& files, Context& context) {
  if (files.empty()) return;
  context.print(fmt::format("removed {} of an earlier run: {}{}", files.size() == 1 ? "a file" : "files",
                            files.front().string(),
                            files.size() == 1 ? "" : " to " + files.back().filename().string()));
}

void finish_parts(pcd::PartsWriter& writer, std::size_t count, std::string_view what, Context& context) {
  const auto files = writer.commit();
  auto names = nlohmann::json::array();
  for (const auto& file : files) {
    names.push_back(file.string());
    context.wrote(file);
  }
  report_removed(writer.remove_older(), context);
  std::string where = files.front().string();
  if (files.size() > 1) {
    where += fmt::format(" {} {}", files.size() == 2 ? "and" : "to", files.back().filename().string());
  }
  context.print(fmt::format("{} {} in {}", count, what, where));
  context.report({{std::string(what), count}, {"files", names}});
}

}  // namespace crisp::write
