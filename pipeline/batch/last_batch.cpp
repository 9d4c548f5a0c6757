// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/batch/last_batch.hpp"

#include <fstream>
#include <string>

#include <crisp/error.hpp>

#include "pipeline/batch/manifest.hpp"
#include "pipeline/batch/manifest_line.hpp"

namespace crisp::batch {

nlohmann::ordered_json last_batch(const std::filesystem::path& output) {
  std::string last;
  std::int64_t time = 0;
  for (const auto& manifest : manifests_of(output)) {
    std::ifstream stream(manifest, std::ios::binary);
    if (!stream) throw Error("cannot read " + manifest.string(), "check its rights");
    for (std::string line; std::getline(stream, line) && !stream.eof();) {
      if (!line.starts_with(R"({"event":"batch")")) continue;
      const auto event = parse_manifest_line(line);
      if (!event || event->time < time) continue;
      time = event->time;
      last = line;
    }
    if (stream.bad()) throw Error("cannot read " + manifest.string(), "check the disk");
  }
  return last.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json::parse(last);
}

}  // namespace crisp::batch
