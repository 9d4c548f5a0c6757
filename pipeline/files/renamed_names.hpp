// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "pipeline/files/yaml.hpp"

namespace crisp::files {

/// A name that earlier releases had for what users have in their files.
struct RenamedName {
  enum class Kind { stage, option, key };

  Kind kind = Kind::stage;
  std::string_view owner;     ///< of an option its stage, of a key its kind of file; empty for a stage
  std::string_view old_name;  ///< accepted for one release, with a warning
  std::string_view name;      ///< today's
};

/// All names that are accepted for one release.
std::span<const RenamedName> renamed_names();

/// Today's name of a stage, an option or a key; the given one where it was not renamed.
std::string current_name(RenamedName::Kind kind, std::string_view owner, std::string_view name);

/// The warning about an old name: what it is called today.
Error old_name_warning(std::string_view old_name, std::string_view name, Place place = {});

/// Receives warnings about old names.
using OldNameSink = std::function<void(const Error& warning)>;

/// Renames the old keys of a file, at any depth, and reports each of them once.
/// @param owner  the kind of file: "calibration", "diagnosis"
void rename_old_keys(YamlNode& root, std::string_view owner, const OldNameSink& warn);

/// The same for JSON, without a warning: for what a program wrote and a program reads ("summary").
/// @tparam Json  nlohmann::json or nlohmann::ordered_json
template <class Json>
void rename_old_keys(Json& root, std::string_view owner);

}  // namespace crisp::files
