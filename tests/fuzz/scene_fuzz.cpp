// SPDX-License-Identifier: BSD-3-Clause
// Scenes in YAML: whatever the bytes are, either a scene that rays can be cast into, or an Error.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include <crisp/error.hpp>

#include "grabbers/simulate/ray_caster.hpp"
#include "grabbers/simulate/scene_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const crisp::simulate::Scene scene =
        crisp::simulate::parse_scene(crisp::files::parse_yaml(text, "scene.yaml"));
    const crisp::simulate::RayCaster caster(scene);
    const auto hit = caster.cast({{0, 0, 0}, {0.6, 0.64, 0.48}}, 50);
    if (hit && !(hit->distance > 0 && hit->distance <= 50)) std::abort();
    if (std::isnan(caster.distance({1, 2, 3}))) std::abort();
  } catch (const crisp::Error&) {
    return 0;
  }
  return 0;
}
