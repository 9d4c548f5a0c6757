// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace crisp::app {

/// The pipelines that are installed with crisp, which can be called by name.
class InstalledPipelines {
 public:
  /// @param folders  where they may lie; those that do not exist are passed over
  explicit InstalledPipelines(std::vector<std::filesystem::path> folders) : folders_(std::move(folders)) {}

  /// Pipelines of the program or library in this folder, installed or in its build tree.
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

/// Pipelines of this program, wherever it is installed.
InstalledPipelines pipelines_of_program();

}  // namespace crisp::app
