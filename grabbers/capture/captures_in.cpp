// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/captures_in.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

#include <crisp/error.hpp>

#include "grabbers/capture/capture_file.hpp"
#include "pipeline/files/list_files.hpp"

namespace crisp::capture {
namespace {

/// [ns since the Unix epoch] When the first packet came. @throws Error if there is none, or no capture
std::int64_t first_packet(const std::filesystem::path& file) {
  CaptureFile capture(file);
  const Packet* packet = capture.next();
  if (packet == nullptr) throw Error(file.string() + " holds no packet", "remove it, or capture it again");
  return packet->time_ns;
}

bool begins_like_a_capture(const std::filesystem::path& file) {
  FileWindow window(file);
  const auto begin = window.peek(4);
  return PcapRecords::recognises(begin) || PcapngBlocks::recognises(begin);
}

bool ought_to_be_a_capture(const std::filesystem::path& file) {
  if (files::has_extension(file, capture_extensions())) return true;
  try {
    return begins_like_a_capture(file);
  } catch (const Error&) {  // unreadable notes do not matter
    return false;
  }
}

}  // namespace

Captures captures_in(const std::filesystem::path& path) {
  std::error_code none;
  if (!std::filesystem::is_directory(path, none)) return {.files = {path}};
  std::vector<std::pair<std::int64_t, std::filesystem::path>> found;
  Captures captures;
  for (const auto& file : files::list_files(path)) {
    try {
      found.emplace_back(first_packet(file), file);
    } catch (const Error& error) {  // notes, rigs and results may lie next to captures
      if (ought_to_be_a_capture(file)) captures.left_out.push_back(error.message());
    }
  }
  if (found.empty()) {
    std::string why;
    for (const auto& reason : captures.left_out) why += (why.empty() ? ": " : "; ") + reason;
    throw Error(path.string() + " is a folder without any capture that can be read" + why,
                "captures come from tcpdump, dumpcap, Wireshark or crisp record");
  }
  std::ranges::sort(found);
  for (auto& [first_ns, file] : found) captures.files.push_back(std::move(file));
  return captures;
}

}  // namespace crisp::capture
