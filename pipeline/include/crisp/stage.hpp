// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <typeinfo>
#include <utility>
#include <vector>

#include <crisp/error.hpp>
#include <crisp/option_set.hpp>

namespace pcl {
template <typename PointT>
class PointCloud;
}

namespace crisp {

struct Scan;
struct PlateReading;
struct ClockMap;
struct Measurements;
class PlateTrajectory;
struct Calibration;
struct Findings;
struct Point;

/// The name under which people know a kind of data. A plugin makes a type of its own flow by specialising it:
///
///     template <> struct crisp::KindName<Thing> { static constexpr std::string_view value = "Thing"; };
///
/// Only names are here: whoever takes or gives a kind includes the header that defines it.
template <class T>
struct KindName;

/// @cond
// clang-format off
template <> struct KindName<Scan> { static constexpr std::string_view value = "Scan"; };
template <> struct KindName<PlateReading> { static constexpr std::string_view value = "PlateReading"; };
template <> struct KindName<ClockMap> { static constexpr std::string_view value = "ClockMap"; };
template <> struct KindName<Measurements> { static constexpr std::string_view value = "Measurements"; };
template <> struct KindName<PlateTrajectory> { static constexpr std::string_view value = "PlateTrajectory"; };
template <> struct KindName<Calibration> { static constexpr std::string_view value = "Calibration"; };
template <> struct KindName<pcl::PointCloud<Point>> { static constexpr std::string_view value = "Cloud"; };
template <> struct KindName<Findings> { static constexpr std::string_view value = "Findings"; };
// clang-format on
/// @endcond

/// A kind of data that flows between stages: a C++ type and its name.
class Kind {
 public:
  template <class T>
  /// The kind of a C++ type. @tparam T  a type that KindName knows
  static Kind of() {
    return {KindName<T>::value, typeid(T)};
  }

  /// The name under which people know the kind: "Scan".
  std::string_view name() const { return name_; }
  /// Whether both are of the same C++ type.
  bool operator==(const Kind& other) const { return *type_ == *other.type_; }

 private:
  Kind(std::string_view name, const std::type_info& type) : name_(name), type_(&type) {}

  std::string_view name_;
  const std::type_info* type_;
};

/// One thing that flows, immutable once passed on.
struct Item {
  Kind kind;                          ///< of the value
  std::shared_ptr<const void> value;  ///< of the kind's C++ type

  template <class T>
  /// An item that holds a value of type T.
  static Item of(std::shared_ptr<const T> value) {
    return {Kind::of<T>(), std::move(value)};
  }
  template <class T>
  /// The value, or nullptr if it is of another kind.
  std::shared_ptr<const T> as() const {
    return kind == Kind::of<T>() ? std::static_pointer_cast<const T>(value) : nullptr;
  }
};

class Context;
struct RunSettings;

/// Inputs of a stage's call: the item that drives the call, and the latest of every held kind.
class Inputs {
 public:
  /// @param items  of the call: the one that drives it, and those held
  explicit Inputs(std::span<const Item> items) : items_(items) {}

  /// The item of kind T, or nullptr: of a held kind the latest, of a driving kind the one that this call is
  /// for.
  template <class T>
  const T* find() const {
    return share<T>().get();
  }
  /// @throws Error if there is no item of this kind
  template <class T>
  const T& get() const {
    const T* item = find<T>();
    if (!item)
      throw Error("there is no " + std::string(KindName<T>::value) + " here",
                  "let describe() take it, or test by find()");
    return *item;
  }
  /// As find(), for stages that keep the item beyond the call.
  template <class T>
  std::shared_ptr<const T> share() const {
    for (const auto& item : items_) {
      if (auto value = item.as<T>()) return value;
    }
    return nullptr;
  }

 private:
  std::span<const Item> items_;
};

/// Receives a stage's items. A given item runs through the stages below before give() returns.
class Outputs {
 public:
  /// @param sink  runs an item through the stages below
  explicit Outputs(std::function<void(Item)> sink) : sink_(std::move(sink)) {}

  /// Gives an item that the stage may keep.
  template <class T>
  void give(std::shared_ptr<const T> item) {
    sink_(Item::of<T>(std::move(item)));
  }
  /// Gives an item that the stage has made; it must not change any more.
  template <class T>
  void give(std::shared_ptr<T> item) {
    give(std::shared_ptr<const T>(std::move(item)));
  }
  /// Gives an item by value.
  template <class T>
  void give(T item) {
    give(std::make_shared<const T>(std::move(item)));
  }

 private:
  std::function<void(Item)> sink_;
};

/// One step of a pipeline. A class S derived from it also has `static void describe(StageDescription<S>&)`.
class Stage {
 public:
  Stage() = default;
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;
  virtual ~Stage() = default;

  /// Called once all options are set, before any file is opened: throws an Error for what the declarations of
  /// single options cannot check (a minimum above a maximum, a laser that the rig does not have).
  virtual void check(const RunSettings&) const {}

  /// Called for each item of a driving kind, once everything that the stage holds is there. A stage that
  /// takes nothing is a source: it is called once and gives everything that it has.
  virtual void process(const Inputs& in, Outputs& out, Context& context) = 0;

  /// Called once, after the last item; gives what a whole set was needed for.
  virtual void finish(Outputs&, Context&) {}
};

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
