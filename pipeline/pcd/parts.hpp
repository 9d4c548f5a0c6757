// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <list>
#include <optional>
#include <string>
#include <vector>

#include <crisp/pcd_table.hpp>

namespace crisp::pcd {

/// The name of the n-th of the files that a long recording is cut into: cloud.pcd → cloud_0001.pcd.
std::filesystem::path part_path(const std::filesystem::path& file, std::size_t number);

/// The base name of a part: cloud_0001.pcd → cloud.pcd, if the file's header confirms that it is that part.
/// Nothing for other files.
std::optional<std::filesystem::path> whole_of_part(const std::filesystem::path& file);

/// In a part's header: which one it is.
inline constexpr const char* kPart = "part";

/// Removes cloud_0004.pcd, cloud_0005.pcd … if `file` is cloud.pcd and `last` 3, if their headers confirm
/// their numbers, with the files next to them.
/// @param note  of the header, with the number
/// @return the removed parts, without the files next to them
/// @throws Error if one cannot be removed
std::vector<std::filesystem::path> remove_numbered_beyond(const std::filesystem::path& file, std::size_t last,
                                                          const std::string& note);

/// Writes a long table as several files: the first is only named when it is known whether there will be a
/// second. Each header holds the part's number, whether another follows, and the predecessor's content. The
/// files take their names together, by commit(); without it nothing remains of them.
class PartsWriter {
 public:
  PartsWriter(std::filesystem::path file, PcdFormat format) : file_(std::move(file)), format_(format) {}

  /// Writes the next part.
  /// @param more whether another follows
  /// @return the part's file
  std::filesystem::path write(PcdTable table, bool more);
  /// Adds a file that belongs to a part.
  void write_next_to(const std::filesystem::path& file, const PcdTable& table);
  /// @return all files, in the order in which they were written
  std::vector<std::filesystem::path> commit();
  /// To be called after commit(): removes files of an earlier run under this name that this run did not
  /// write, so that all parts are of one run. Numbered files are removed if their headers confirm their
  /// numbers.
  /// @return the removed parts, without the files next to them
  /// @throws Error if it cannot be removed
  std::vector<std::filesystem::path> remove_older() const;

 private:
  std::filesystem::path file_;
  PcdFormat format_;
  std::size_t parts_ = 0;  ///< 0: all in one file
  std::string last_;       ///< digest of the part that was written last
  std::list<AtomicFile> files_;
};

/// Reads `file`, or if there is none the parts that it was cut into; or, if it is itself a part, that one and
/// those behind it. Calls `use` for each.
/// @throws Error if a part is missing, its header has another number or another predecessor (as where a run
/// ended
///         between the parts of an earlier one), or both a file and parts are there
void read_parts(const std::filesystem::path& file,
                const std::function<void(const PcdTable&, const std::filesystem::path&)>& use);

}  // namespace crisp::pcd
