// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <crisp/calibration_file.hpp>

#include "pipeline/data/each_parameter.hpp"
#include "plugins/write/calibration_stage.hpp"
#include "plugins/write/calibrations_compared.hpp"
#include "plugins/write/urdf.hpp"

namespace crisp::write {
namespace {

Inspection inspect(const std::filesystem::path& file, const Rig&) {
  const Calibration calibration = read_calibration(file);
  Inspection inspection;
  inspection.text = fmt::format("  {:<36}{:>14} {:<5}{:>12}", "parameter", "value", "unit", "std error");
  data::for_each_parameter(calibration, [&](const std::string& name, const Parameter& p) {
    const std::string error = p.free ? fmt::format("{:12.2g}", p.std_error) : fmt::format("{:>12}", "fixed");
    inspection.text += fmt::format("\n  {:<36}{:>14.8g} {:<5}{}", name, p.value, p.unit, error);
    inspection.data["parameters"][name] = {
        {"value", p.value}, {"unit", p.unit}, {"std_error", p.std_error}, {"free", p.free}};
  });
  for (const auto& [name, value] : calibration.quality) {
    inspection.text += fmt::format("\n  {:<36}{:>14.8g}", name, value);
  }
  for (const auto& u : calibration.unobservable) {
    inspection.text += fmt::format("\n  unobservable: {}: {}", u.parameter, u.reason);
    inspection.data["unobservable"].push_back(u.parameter);
  }
  for (const auto& caveat : calibration.caveats) inspection.text += "\n  UNTRUSTED: " + caveat;
  inspection.data["caveats"] = calibration.caveats;
  inspection.data["quality"] = calibration.quality;
  inspection.data["provenance"] = calibration.provenance;
  for (const auto& [key, value] : calibration.provenance)
    inspection.text += fmt::format("\n  {}: {}", key, value);
  return inspection;
}

/// Both a rig and a calibration begin with the schema and the lasers; only a calibration gives values of
/// them, or caveats, which stand before.
bool recognises(std::string_view head) {
  const auto has = [head](const char* key) { return head.find(key) != std::string_view::npos; };
  return has("crisp:") && (has("\ndoubts:") || (has("lasers:") && has("value:")));
}

}  // namespace

Inspector calibration_inspector() {
  return {.kind = "a calibration",
          .recognises = recognises,
          .inspect = inspect,
          .compare =
              [](const std::filesystem::path& first, const std::filesystem::path& second) {
                return compare_calibrations(read_calibration(first), read_calibration(second));
              },
          .urdf = [](const std::filesystem::path& file,
                     const Rig& rig) { return to_urdf(read_calibration(file), rig); }};
}

}  // namespace crisp::write
