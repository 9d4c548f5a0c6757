// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <crisp/context.hpp>

#include "grabbers/simulate/effects.hpp"
#include "grabbers/simulate/nominal_errors.hpp"
#include "grabbers/simulate/scene.hpp"
#include "grabbers/simulate/settings.hpp"

namespace crisp::simulate {

/// Which scene a stage simulates.
struct SceneChoice {
  std::string name = "office";  ///< a built-in one, or paper: paper_room()
  std::filesystem::path file;   ///< in its place, unless empty: see read_scene()

  /// @throws Error if there is none of this name; what read_scene() throws
  Scene load(Context& context) const;
};

/// The truth of the scanner that a stage simulates.
struct TruthChoice {
  NominalErrors nominal_errors;
  std::filesystem::path calibration_file;  ///< in place of one that is drawn around nominal, unless empty
  OptionGroups effects;                    ///< put on top: see read_effects()

  /// Drawn around nominal; reads no file.
  Calibration drawn(const RunSettings& run, std::uint64_t seed) const;

  /// The file's, or else drawn.
  /// @throws Error if the file is not a calibration of the run's rig
  Calibration load(Context& context, std::uint64_t seed) const;
};

/// Which lasers of a scanner that a stage simulates are of another kind than the rest.
struct KindChoice {
  OptionGroups lasers;  ///< by name: see read_patterns()

  /// Sets the field of view and rate of each laser of the scanner's rig. @throws Errors as read_patterns()
  void apply(ScannerSettings& scanner) const;
};

/// Which real devices those that a stage simulates are like.
struct RealismChoice {
  std::vector<std::string> devices;  ///< see effects_of_real_devices()
  std::filesystem::path
      findings_file;  ///< of a diagnosis, unless empty: see effects_of(); goes before `devices`

  /// The effects of the simulated devices. Findings that cannot be simulated are reported by name.
  ///
  /// @param catalogue         effects that can be simulated
  /// @throws Error or Errors  as effects_of_real_devices(), read_findings() and effects_of() do
  std::vector<Effect> load(const std::vector<EffectInfo>& catalogue, Context& context) const;

  bool empty() const { return devices.empty() && findings_file.empty(); }
};

/// The terms that the program knows; none where a stage is run without one.
const TermRegistry& known_terms(const RunSettings& run);

}  // namespace crisp::simulate
