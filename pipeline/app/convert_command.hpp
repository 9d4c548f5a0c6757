// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "pipeline/app/commands.hpp"

namespace crisp::app {

/// `crisp convert`.
struct ConvertRequest {
  std::filesystem::path from;  ///< a file, or a folder of them
  std::filesystem::path to;    ///< a file; a folder where `format` is given
  std::string format;          ///< "pcd", "ply" or "las"; empty: as the file's name ends
  RunRequest run;
};

/// Runs configs/convert.yaml for a cloud, or for each in a folder. A cloud in parts (NAME_0001.pcd …) becomes
/// one. A cloud that cannot be converted does not keep the others from it; the status is the worst of all.
ExitStatus convert_command(const ConvertRequest& request, const Registrar& registrar);

}  // namespace crisp::app
