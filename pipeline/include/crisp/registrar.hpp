// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <typeindex>
#include <vector>

#include <crisp/rig.hpp>
#include <crisp/stage.hpp>

namespace crisp {

/// Description of a file: for people, and for programs.
// NOLINTNEXTLINE(bugprone-exception-escape): moving JSON checks what it holds
struct Inspection {
  std::string text;     ///< lines, without a line break at the end
  nlohmann::json data;  ///< the same as an object
};

/// Describes the content of files of some kind: `crisp info`.
struct Inspector {
  std::string kind;  ///< "a capture"
  /// Whether the file is of that kind, by its first bytes (up to 4096 of them).
  std::function<bool(std::string_view head)> recognises;
  /// @throws Error if the file cannot be read
  std::function<Inspection(const std::filesystem::path& file, const Rig& rig)> inspect;
  /// The extensions of such files, ".pcap": one that is named so (see has_extension()) and is none is an
  /// error.
  std::vector<std::string> extensions = {};
  /// Compares two files of this kind, as lines for people; empty where files are described one by one.
  /// @throws Error if one cannot be read
  std::function<std::string(const std::filesystem::path& first, const std::filesystem::path& second)>
      compare = {};
  /// The content of a file of this kind as URDF for ROS; empty where it has none.
  /// @throws Error if it cannot be read
  std::function<std::string(const std::filesystem::path& file, const Rig& rig)> urdf = {};
};

using Inspectors = std::vector<Inspector>;

/// The stages that are known, by name.
class StageRegistry {
 public:
  /// @throws Error if the name is taken or malformed, or the description is incomplete or contradicts itself
  void add(StageType type);

  const StageType* find(const std::string& name) const;  ///< nullptr if there is none
  std::vector<const StageType*> all() const;             ///< by name
  /// All known names, in alphabetical order.
  std::vector<std::string> names() const;
  std::vector<std::string> givers(const Kind& kind) const;  ///< names of the stages that give it

 private:
  std::map<std::string, StageType> types_;
};

/// Argument of a family's or plugin's `void register_xxx(Registrar&)`. Stages have their registry here;
/// registries of other things (terms of the sensor model, measures …) are attached by the program, so that
/// this library need not know them:
///
///     registrar.stage<DeskewStage>();
///     registrar.get<TermRegistry>().add(...);
class Registrar {
 public:
  /// Adds a stage type. @tparam S  derived from Stage, with `static void describe(StageDescription<S>&)`
  /// @throws Error  if a stage of that name is known
  template <class S>
  void stage() {
    StageType type = describe_stage<S>();
    type.origin = origin_;
    stages_.add(std::move(type));
  }
  /// For `crisp info`: describes files of one more kind. The first inspector that recognises a file is used.
  void inspector(Inspector inspector) { inspectors_.push_back(std::move(inspector)); }
  const Inspectors& inspectors() const { return inspectors_; }  ///< all that were added

  StageRegistry& stages() { return stages_; }              ///< the stage types
  const StageRegistry& stages() const { return stages_; }  ///< the stage types

  /// Adds a registry, which must outlive the registrar.
  /// @param kind  what one thing in it is called, if all are to be listed: "term"
  template <class R>
  void attach(R& registry, std::string kind = {}) {
    Attached& other = others_[typeid(R)];
    other.registry = &registry;
    other.kind = std::move(kind);
    if constexpr (requires { registry.names(); }) {
      other.names = [&registry] { return registry.names(); };
      other.snapshot = [&registry] { return [&registry, was = registry] { registry = was; }; };
    }
  }
  /// @throws Error if no registry of this type is attached
  template <class R>
  R& get() const {
    return *static_cast<R*>(other(typeid(R)));
  }

  /// All registered names, in order: "stage write.pcd", "term mirror.cone".
  std::vector<std::string> registered() const;
  /// Returns a function that undoes all later registrations.
  std::function<void()> snapshot();

  /// Sets the origin of the next registrations: "built in", or a plugin's file.
  void set_origin(std::string origin) { origin_ = std::move(origin); }
  const std::string& origin() const {
    return origin_;
  }  ///< "built in", or the file of the plugin that registers

 private:
  /// A registry of things that are not stages.
  struct Attached {
    void* registry = nullptr;
    std::string kind;
    std::function<std::vector<std::string>()> names;
    std::function<std::function<void()>()> snapshot;
  };

  void* other(std::type_index type) const;

  StageRegistry stages_;
  Inspectors inspectors_;
  std::map<std::type_index, Attached> others_;
  std::string origin_ = "built in";
};

}  // namespace crisp
