// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace crisp::simulate {

/// A file of configs that came with crisp when it was built.
struct BuiltIn {
  std::string_view name;
  std::string_view yaml;
};

std::span<const BuiltIn> scene_texts();   ///< of configs/scenes
std::span<const BuiltIn> device_texts();  ///< of configs/devices

std::vector<std::string> names_of(std::span<const BuiltIn> all);

/// @param kind  "scene", for the message
/// @throws Error for a name that is not there, with the nearest one
std::string_view text_of(std::span<const BuiltIn> all, std::string_view kind, const std::string& name);

}  // namespace crisp::simulate
