// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/pcd/parts.hpp"

#include <fmt/format.h>

#include <charconv>
#include <fstream>
#include <optional>

#include <crisp/atomic_file.hpp>
#include <crisp/error.hpp>
#include <crisp/measurement_tables.hpp>

#include "pipeline/files/list_files.hpp"

namespace crisp::pcd {
namespace {

namespace fs = std::filesystem;

const std::string kNext = "next_part";
const std::string kBefore = "part_before";  // digest of what it holds

/// @throws Error  if the part's header names another predecessor; files of other programs are not checked
void check_follows(const PcdTable& part, const std::string& before, const fs::path& file) {
  const auto printed = part.header().notes.find(kBefore);
  if (before.empty() || printed == part.header().notes.end() || printed->second == before) return;
  throw Error(
      file.string() + " does not continue the part before it: it is of another run, which was interrupted",
      "repeat the run that wrote them");
}

/// The file that a recording begins with.
fs::path first_file(const fs::path& file) {
  if (fs::is_directory(file)) {
    throw Error(file.string() + " is a folder, not a PCD file", "name one file, and run crisp once for each");
  }
  fs::path part = part_path(file, 1);
  if (!fs::exists(part)) return file;  // if that is missing as well, reading it reports the error
  if (fs::exists(file)) {
    throw Error(fmt::format("both {} and {} are there", file.string(), part.filename().string()),
                "name the latter to read the parts, or remove the older file");
  }
  return part;
}

/// "cloud_0003.pcd" → "cloud_0004.pcd"
fs::path following(const fs::path& part, std::size_t next) {
  const std::string stem = part.stem().string();
  const fs::path whole = part.parent_path() / (stem.substr(0, stem.rfind('_')) + part.extension().string());
  if (next == 0 || part_path(whole, next - 1) != part) {
    throw Error(fmt::format("{} is not named as part {} of a recording", part.string(), next - 1),
                "restore its original name");
  }
  return part_path(whole, next);
}

/// N of cloud_000N.pcd, where `file` is cloud.pcd; nothing of files with another name.
std::optional<std::size_t> number_of(const fs::path& candidate, const fs::path& file) {
  const std::string stem = candidate.stem().string();
  const std::string before = file.stem().string() + "_";
  if (!stem.starts_with(before)) return std::nullopt;
  std::size_t number = 0;
  const auto read = std::from_chars(stem.data() + before.size(), stem.data() + stem.size(), number);
  if (read.ec != std::errc() || part_path(file, number) != candidate) return std::nullopt;
  return number;
}

/// The header of a PCD file; nothing if it is not one that crisp wrote.
/// @throws Error  if the file is there and cannot be read: it may be of an earlier run
std::optional<PcdHeader> own_header(const fs::path& file) {
  constexpr std::size_t kLongestHeader = 4096;  // [bytes] that crisp writes
  std::string head(kLongestHeader, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(head.data(), kLongestHeader);
  std::error_code not_there;
  const bool is_read = stream.is_open() && !stream.bad();
  if (!is_read && fs::is_regular_file(file, not_there)) {
    throw Error("cannot read " + file.string() + ", which may be of an earlier run",
                "remove it, or write to another name");
  }
  try {
    PcdHeader header = parse_pcd_header(head, file.string());
    return header.notes.empty() ? std::nullopt : std::optional(std::move(header));
  } catch (const Error&) {
    return std::nullopt;
  }
}

/// Whether a PCD file's header has this part number.
bool has_number(const fs::path& file, std::size_t number, const std::string& note) {
  const auto header = own_header(file);
  try {
    return header && header->note<std::size_t>(note) == number;
  } catch (const Error&) {
    return false;
  }
}

void remove_old(const fs::path& file) {
  std::error_code failure;
  fs::remove(file, failure);
  if (!failure) return;
  throw Error("cannot remove " + file.string() + ", of an earlier run: " + failure.message(),
              "remove it, or write to another name");
}

/// The record goes first: without its file nothing would remove it later.
void remove_with_record(const fs::path& file) {
  remove_old(file.string() + kProvenance);
  remove_old(file);
}

/// Removes a file that crisp wrote, and the plate's file next to it.
void remove_own(const fs::path& file) {
  if (own_header(plate_path(file))) remove_with_record(plate_path(file));
  remove_with_record(file);
}

}  // namespace

std::vector<fs::path> remove_numbered_beyond(const fs::path& file, std::size_t last,
                                             const std::string& note) {
  std::vector<fs::path> removed;
  for (const auto& candidate : files::list_files(file.has_parent_path() ? file.parent_path() : ".")) {
    const fs::path named = file.parent_path() / candidate.filename();
    const auto number = number_of(named, file);
    if (!number || *number <= last || !has_number(named, *number, note)) continue;
    remove_own(named);
    removed.push_back(named);
  }
  return removed;
}

fs::path part_path(const fs::path& file, std::size_t number) {
  return file.parent_path() /
         fmt::format("{}_{:04}{}", file.stem().string(), number, file.extension().string());
}

std::optional<fs::path> whole_of_part(const fs::path& file) {
  const std::string stem = file.stem().string();
  const fs::path whole = file.parent_path() / (stem.substr(0, stem.rfind('_')) + file.extension().string());
  const auto number = number_of(file, whole);
  return number && has_number(file, *number, kPart) ? std::optional(whole) : std::nullopt;
}

fs::path PartsWriter::write(PcdTable table, bool more) {
  fs::path file = file_;
  if (more || parts_ > 0) {
    ++parts_;
    file = part_path(file_, parts_);
    table.set_note(kPart, std::to_string(parts_));
    if (more) table.set_note(kNext, std::to_string(parts_ + 1));
    if (!last_.empty()) table.set_note(kBefore, last_);
    last_ = table.digest();
  }
  write_next_to(file, table);
  return file;
}

void PartsWriter::write_next_to(const fs::path& file, const PcdTable& table) {
  write_pcd(files_.emplace_back(file), table, format_);
}

std::vector<fs::path> PartsWriter::commit() {
  std::vector<fs::path> written;
  for (auto& file : files_) {
    file.commit();
    written.push_back(file.path());
  }
  files_.clear();
  return written;
}

std::vector<fs::path> PartsWriter::remove_older() const {
  auto removed = remove_numbered_beyond(file_, parts_, kPart);
  if (parts_ > 0 && own_header(file_)) {
    remove_own(file_);
    removed.push_back(file_);
  }
  return removed;
}

void read_parts(const fs::path& file, const std::function<void(const PcdTable&, const fs::path&)>& use) {
  fs::path now = first_file(file);
  std::string before;
  for (bool more = true; more;) {
    const PcdTable table = read_pcd(now);
    check_follows(table, before, now);
    before = table.digest();
    use(table, now);
    const auto next = table.header().note<std::size_t>(kNext);
    more = next.has_value();
    if (more) now = following(now, *next);
  }
}

}  // namespace crisp::pcd
