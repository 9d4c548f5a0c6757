// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <crisp/option_set.hpp>
#include <crisp/stage.hpp>

namespace crisp {

/// Whether a stage can work without an input.
enum class Need { required, optional };

/// One kind that a stage takes.
struct StageInput {
  Kind kind;             ///< of data
  bool held = false;     ///< the latest is kept; it does not make the stage run
  bool required = true;  ///< whether the stage cannot work without it
};

/// A stage as the registry describes it, without an instance of it.
struct StageType {
  std::string name;                              ///< "calibrate.rqe"
  std::string summary;                           ///< in half a sentence
  std::string details;                           ///< paragraphs in Markdown
  std::string origin;                            ///< "built in", or the file of the plugin
  std::vector<StageInput> inputs;                ///< what it takes and holds; empty: it is a source
  std::vector<Kind> outputs;                     ///< what it gives
  std::vector<Option> options;                   ///< in the order of declaration
  std::map<std::string, std::string> groups;     ///< of options, and what they have in common
  bool endless = false;                          ///< a source that ends only when the run is stopped
  std::function<std::unique_ptr<Stage>()> make;  ///< a fresh stage, with all options at their defaults
  std::function<void*(Stage&)> options_object;   ///< what Option::set and Option::get want of a stage

  /// Whether it takes nothing.
  bool is_source() const { return inputs.empty(); }
  const Option* find_option(const std::string& option) const;  ///< nullptr if there is none
  /// Whether options are in a group of this name: "motion", "links.laser", and therefore "links".
  bool has_group(std::string_view group) const;
  /// Whether it may give items of this kind.
  bool gives(const Kind& kind) const;
};

/// Description of a stage S: what it takes and gives, and its options. See Stage and
/// docs/how-to/write-a-stage.md.
template <class S>
class StageDescription {
 public:
  /// "family.name", lower case.
  StageDescription& name(std::string text) { return with(type_.name, std::move(text)); }
  /// Summary in half a sentence: "places each beam at the plate's angle of its firing time".
  StageDescription& summary(std::string text) { return with(type_.summary, std::move(text)); }
  /// Paragraphs for the reference page, in Markdown.
  StageDescription& details(std::string text) { return with(type_.details, std::move(text)); }

  /// process() is called for each item of this kind.
  template <class T>
  StageDescription& takes(Need need = Need::required) {
    type_.inputs.push_back({Kind::of<T>(), false, need == Need::required});
    return *this;
  }
  /// The latest item of this kind is at hand in process(), which is not called before the first is there:
  /// what drives the stage waits, in order. An optional one is waited for if a stage above gives its kind.
  template <class T>
  StageDescription& holds(Need need = Need::required) {
    type_.inputs.push_back({Kind::of<T>(), true, need == Need::required});
    return *this;
  }
  /// The stage may give items of this kind.
  template <class T>
  StageDescription& gives() {
    type_.outputs.push_back(Kind::of<T>());
    return *this;
  }

  /// Marks a source without an end of its own: stopping the run ends the source, and the other stages finish.
  StageDescription& endless() {
    type_.endless = true;
    return *this;
  }

  /// option(name, member or chain of up to three, help), see OptionSet::add.
  template <class... Arguments>
  auto option(std::string option_name, Arguments&&... way_and_help) {
    return options_.add(std::move(option_name), std::forward<Arguments>(way_and_help)...);
  }

  /// What the options of a group are of: "links.laser", "delays of the lasers' telegrams".
  StageDescription& group(std::string group_name, std::string help) {
    type_.groups[std::move(group_name)] = std::move(help);
    return *this;
  }

  /// The complete description.
  StageType build() && {
    type_.options.assign(options_.all().begin(), options_.all().end());
    type_.make = [] { return std::make_unique<S>(); };
    type_.options_object = [](Stage& stage) -> void* { return static_cast<S*>(&stage); };
    return std::move(type_);
  }

 private:
  StageDescription& with(std::string& field, std::string text) {
    field = std::move(text);
    return *this;
  }

  StageType type_;
  OptionSet<S> options_;
};

template <class S>
StageType describe_stage() {
  StageDescription<S> description;
  S::describe(description);
  return std::move(description).build();
}

}  // namespace crisp
