// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/pcd/parts.hpp"

#include <fmt/format.h>

#include "pipeline/data/error.hpp"

namespace crisp {
namespace {

namespace fs = std::filesystem;

const std::string kPart = "part";
const std::string kNext = "next_part";

/// The file that a recording begins with.
fs::path first_file(const fs::path& file) {
  if (fs::is_directory(file)) {
    throw Error(file.string() + " is a folder, not a PCD file", "name one file, and run crisp once for each");
  }
  fs::path part = part_path(file, 1);
  if (!fs::exists(part)) return file;  // if that is not there either, reading it says so
  if (fs::exists(file)) {
    throw Error(fmt::format("both {} and {} are there", file.string(), part.filename().string()),
                "name the latter to read the parts, or remove what is older");
  }
  return part;
}

/// "cloud_0003.pcd" → "cloud_0004.pcd"
fs::path following(const fs::path& part, std::size_t next) {
  const std::string stem = part.stem().string();
  const fs::path whole = part.parent_path() / (stem.substr(0, stem.rfind('_')) + part.extension().string());
  if (next == 0 || part_path(whole, next - 1) != part) {
    throw Error(fmt::format("{} is not named as part {} of a recording", part.string(), next - 1),
                "give it the name that it was written under");
  }
  return part_path(whole, next);
}

}  // namespace

fs::path part_path(const fs::path& file, std::size_t number) {
  return file.parent_path() /
         fmt::format("{}_{:04}{}", file.stem().string(), number, file.extension().string());
}

fs::path PartsWriter::write(PcdTable table, bool more) {
  fs::path file = file_;
  if (more || parts_ > 0) {
    ++parts_;
    file = part_path(file_, parts_);
    table.set_note(kPart, std::to_string(parts_));
    if (more) table.set_note(kNext, std::to_string(parts_ + 1));
  }
  write_beside(file, table);
  return file;
}

void PartsWriter::write_beside(const fs::path& file, const PcdTable& table) {
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

void read_parts(const fs::path& file, const std::function<void(const PcdTable&, const fs::path&)>& use) {
  fs::path now = first_file(file);
  for (bool more = true; more;) {
    const PcdTable table = read_pcd(now);
    use(table, now);
    const auto next = table.header().note<std::size_t>(kNext);
    more = next.has_value();
    if (more) now = following(now, *next);
  }
}

}  // namespace crisp
