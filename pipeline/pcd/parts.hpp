// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <list>

#include "pipeline/pcd/pcd_table.hpp"

namespace crisp {

/// The name of the n-th of the files that a long recording is cut into: cloud.pcd → cloud_0001.pcd.
std::filesystem::path part_path(const std::filesystem::path& file, std::size_t number);

/// Writes what is too long for one file as several: the first is only named when it is known whether there
/// will be a second. Each says in its header which part it is, and whether another follows. They take their
/// names together, by commit(); without it nothing remains of them.
class PartsWriter {
 public:
  PartsWriter(std::filesystem::path file, PcdFormat format) : file_(std::move(file)), format_(format) {}

  /// Writes the next part.
  /// @param more whether another follows
  /// @return the part's file
  std::filesystem::path write(PcdTable table, bool more);
  /// Adds a file that belongs to a part.
  void write_beside(const std::filesystem::path& file, const PcdTable& table);
  /// @return all files, in the order in which they were written
  std::vector<std::filesystem::path> commit();

 private:
  std::filesystem::path file_;
  PcdFormat format_;
  std::size_t parts_ = 0;
  std::list<AtomicFile> files_;
};

/// Reads `file`, or if there is none the parts that it was cut into; or, if it is itself a part, that one and
/// those behind it. Calls `use` for each.
/// @throws Error if a part is missing, is not the part that its name says, or both a file and parts are there
void read_parts(const std::filesystem::path& file,
                const std::function<void(const PcdTable&, const std::filesystem::path&)>& use);

}  // namespace crisp
