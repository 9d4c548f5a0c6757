// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/batch/manifest.hpp"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <system_error>

#include <crisp/atomic_file.hpp>
#include <crisp/error.hpp>

#include "pipeline/batch/manifest_line.hpp"
#include "pipeline/batch/output_name.hpp"
#include "pipeline/files/json_text.hpp"

namespace crisp::batch {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

[[noreturn]] void fail(const fs::path& file, int code) {
  const char* advice = is_disk_full(code)
                           ? "make room on the disk and run the batch again: it continues where it stopped"
                           : "check the folder's permissions";
  throw Error("cannot write " + file.string() + ": " + std::strerror(code), advice);
}

std::string utc_milliseconds() {
  using std::chrono::milliseconds;
  using std::chrono::system_clock;
  const auto now = std::chrono::time_point_cast<milliseconds>(system_clock::now());
  return fmt::format("{:%FT%T}.{:03}Z", fmt::gmtime(system_clock::to_time_t(now)),
                     now.time_since_epoch().count() % 1000);
}

/// The size of a file up to its last line end.
off_t whole_lines(int descriptor, off_t size) {
  std::array<char, 4096> block{};
  while (size > 0) {
    const off_t begin = std::max<off_t>(0, size - static_cast<off_t>(block.size()));
    const ssize_t count = pread(descriptor, block.data(), static_cast<std::size_t>(size - begin), begin);
    if (count <= 0) return size;
    const std::string_view text(block.data(), static_cast<std::size_t>(count));
    const std::size_t end = text.rfind('\n');
    if (end != std::string_view::npos) return begin + static_cast<off_t>(end) + 1;
    size = begin;
  }
  return 0;
}

}  // namespace

std::string_view name_of(JobStatus status) {
  constexpr std::array kNames = {"done", "untrusted", "failed", "interrupted"};
  return kNames.at(static_cast<std::size_t>(status));
}

ManifestWriter::ManifestWriter(fs::path file) : file_(std::move(file)) {
  std::error_code failure;
  fs::create_directories(file_.parent_path(), failure);
  if (failure) fail(file_, failure.value());
  descriptor_ = open(file_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail(file_, errno);
  const off_t size = lseek(descriptor_, 0, SEEK_END);
  const off_t whole = whole_lines(descriptor_, size);
  if (whole < size && ftruncate(descriptor_, whole) != 0) fail(file_, errno);
}

ManifestWriter::~ManifestWriter() { close(descriptor_); }

void ManifestWriter::append(BatchEventKind kind, const Json& event) {
  Json whole = {{"event", name_of(kind)}, {"time", utc_milliseconds()}};
  whole.update(event);
  const std::string line = files::json_text(whole) + "\n";
  const off_t before = lseek(descriptor_, 0, SEEK_END);
  const ssize_t written = write(descriptor_, line.data(), line.size());
  is_synced_ = false;
  if (written == static_cast<ssize_t>(line.size())) return;
  const int code = written < 0 ? errno : ENOSPC;
  static_cast<void>(ftruncate(descriptor_, before));
  fail(file_, code);
}

void ManifestWriter::sync() {
  if (!is_synced_ && fdatasync(descriptor_) != 0) fail(file_, errno);
  is_synced_ = true;
}

std::size_t read_manifest(const fs::path& file,
                          const std::function<void(BatchEvent&& event, std::string_view line)>& use) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    throw Error("cannot read " + file.string() + ": " + std::strerror(errno), "check its permissions");
  }
  std::size_t damaged = 0;
  for (std::string line; std::getline(stream, line) && !stream.eof();) {
    auto event = parse_manifest_line(line);
    if (event)
      use(std::move(*event), line);
    else
      ++damaged;
  }
  if (stream.bad()) throw Error("cannot read " + file.string(), "check the disk");
  return damaged;
}

fs::path task_folder(const fs::path& output, const std::string& task) {
  return output / kBatchManifest / task;
}

std::vector<fs::path> manifests_of(const fs::path& output) {
  std::error_code failure;
  std::vector<fs::path> files;
  fs::directory_iterator task(output / kBatchManifest, failure);
  for (; !failure && task != fs::directory_iterator(); task.increment(failure)) {
    std::error_code none;
    if (fs::exists(task->path() / kManifestFile, none)) files.push_back(task->path() / kManifestFile);
  }
  if (failure && failure != std::errc::no_such_file_or_directory)
    throw Error("cannot read " + (output / kBatchManifest).string() + ": " + failure.message(),
                "check the folder's permissions");
  std::ranges::sort(files);
  return files;
}

Json to_json(const std::vector<InputFile>& files) {
  auto list = Json::array();
  for (const auto& file : files) {
    Json json = {{"file", file.file}, {"bytes", file.bytes}, {"mtime", file.mtime}};
    if (!file.sha256.empty()) json["sha256"] = file.sha256;
    list.push_back(std::move(json));
  }
  return list;
}

}  // namespace crisp::batch
