// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <crisp/registrar.hpp>

namespace crisp {

struct PluginDescriptor;

/// One file that was tried as a plugin.
struct PluginRecord {
  std::filesystem::path file;       ///< as it was found
  std::string name;                 ///< empty if it was not found out
  std::string version;              ///< the plugin's own
  std::string refusal;              ///< why it cannot be used; empty if it can
  std::string warning;              ///< what makes it unsafe to load, though it was; empty if nothing does
  std::string skipped;              ///< which file is used in its place; empty if none is
  std::vector<std::string> brings;  ///< "stage filter.near", "term range.drift"

  /// Whether its registrations are in force.
  bool is_loaded() const { return refusal.empty() && skipped.empty(); }
};

/// Loads plugins for as long as the program runs: they are never unloaded.
///
/// A file is rejected, with the reason in its record, if it is no complete shared object, crashes the
/// system's loader (it is tried in a process of its own first), has no `crisp_plugin`, was built with another
/// compiler, C++ library, alignment or version of crisp (by constants that are read before any function of it
/// is called), or if its registrations are rejected. A plugin whose name is already loaded is skipped.
class PluginLoader {
 public:
  /// @param registrar  receives what the plugins register; outlives this object
  explicit PluginLoader(Registrar& registrar) : registrar_(registrar) {}

  /// Prefers this file or folder among plugins of the same name, wherever others are found first.
  void prefer(const std::filesystem::path& file_or_folder);

  /// Loads a file, or the *.so of a folder in the order of their names.
  void load(const std::filesystem::path& file_or_folder);

  /// All the files that were tried, in order.
  const std::vector<PluginRecord>& tried() const { return tried_; }

 private:
  void load_file(const std::filesystem::path& file);
  void judge_name(PluginRecord& record) const;
  void register_all(PluginRecord& record, const PluginDescriptor& descriptor);

  Registrar& registrar_;
  std::vector<PluginRecord> tried_;
  std::map<std::string, std::filesystem::path> preferred_;  ///< the file of a plugin's name
};

}  // namespace crisp
