// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include <crisp/error.hpp>

namespace crisp::report {

/// Reads JSON that a run wrote, and makes something of it.
/// @throws Error that names the file, if it is no JSON, or not what `use` expects
template <class Use>
auto use_json(const std::filesystem::path& file, const Use& use) {
  using Json = nlohmann::ordered_json;
  std::ifstream stream(file);
  if (!stream) throw Error("cannot read " + file.string(), "check its rights");
  try {
    return use(Json::parse(stream));
  } catch (const Json::exception& error) {
    throw Error(file.string() + " is damaged: " + error.what(), "run the pipeline again");
  }
}

}  // namespace crisp::report
