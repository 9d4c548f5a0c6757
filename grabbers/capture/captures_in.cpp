// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/captures_in.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include "grabbers/capture/capture_file.hpp"
#include "pipeline/data/error.hpp"
#include "pipeline/files/folder.hpp"

namespace crisp {
namespace {

/// [ns since the Unix epoch] When the first packet came; nothing for what is no capture, or holds none.
std::optional<std::int64_t> first_packet(const std::filesystem::path& file) {
  try {
    CaptureFile capture(file);
    const Packet* packet = capture.next();
    if (packet != nullptr) return packet->time_ns;
  } catch (const Error&) {
    // Notes, rigs and results may lie beside captures.
  }
  return {};
}

}  // namespace

std::vector<std::filesystem::path> captures_in(const std::filesystem::path& path) {
  std::error_code none;
  if (!std::filesystem::is_directory(path, none)) return {path};
  std::vector<std::pair<std::int64_t, std::filesystem::path>> found;
  for (const auto& file : files_in(path)) {
    if (const auto first_ns = first_packet(file)) found.emplace_back(*first_ns, file);
  }
  if (found.empty()) {
    throw Error(path.string() + " is a folder without any capture",
                "captures come from tcpdump, dumpcap, Wireshark or crisp record");
  }
  std::ranges::sort(found);
  std::vector<std::filesystem::path> captures;
  for (auto& [first_ns, file] : found) captures.push_back(std::move(file));
  return captures;
}

}  // namespace crisp
