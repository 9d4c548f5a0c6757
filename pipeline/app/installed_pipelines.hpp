// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace crisp {

/// The pipelines that are installed with crisp, which can be called by name.
class InstalledPipelines {
 public:
  /// @param folders  where they may lie; those that do not exist are passed over
  explicit InstalledPipelines(std::vector<std::filesystem::path> folders) : folders_(std::move(folders)) {}

  /// Those of a program or a library in this folder: where it was installed, and where it was built.
  /// @param installed  the pipelines' folder of an installation, relative to this one
  static InstalledPipelines of_folder(const std::filesystem::path& folder,
                                      const std::filesystem::path& installed) {
    return InstalledPipelines({(folder / installed).lexically_normal(), folder / "configs"});
  }

  /// The file that was meant: itself if there is one, or if it has a folder or an ending; otherwise the
  /// installed pipeline of that name.
  /// @throws Error  if the name is of no file and of no pipeline
  std::filesystem::path find(const std::filesystem::path& file_or_name) const;

  /// Their names, in the order of the alphabet.
  std::vector<std::string> names() const;

 private:
  std::vector<std::filesystem::path> folders_;
};

/// Those of this program, wherever it was put.
InstalledPipelines pipelines_of_program();

}  // namespace crisp
