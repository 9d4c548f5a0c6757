// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/scenes.hpp"

#include "grabbers/simulate/built_in.hpp"
#include "grabbers/simulate/scene_file.hpp"

namespace crisp::simulate {

const std::vector<std::string>& built_in_scenes() {
  static const std::vector<std::string> kNames = names_of(scene_texts());
  return kNames;
}

Scene built_in_scene(const std::string& name) {
  return parse_scene(files::parse_yaml(text_of(scene_texts(), "scene", name), name + ".yaml"));
}

Scene office() { return built_in_scene("office"); }

Scene hall() { return built_in_scene("hall"); }

Scene street() { return built_in_scene("street"); }

}  // namespace crisp::simulate
