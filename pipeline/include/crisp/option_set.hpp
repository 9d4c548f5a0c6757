// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <deque>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <string_view>
#include <utility>

#include <crisp/option.hpp>

namespace crisp {

namespace detail {

template <class V>
struct ValueShape {
  using Scalar = V;
  static constexpr bool list = false;
  static constexpr bool automatic = false;
};
template <class V>
struct ValueShape<std::vector<V>> {
  using Scalar = V;
  static constexpr bool list = true;
  static constexpr bool automatic = false;
};
template <class V>
struct ValueShape<std::optional<V>> {
  using Scalar = V;
  static constexpr bool list = false;
  static constexpr bool automatic = true;
};
template <>
struct ValueShape<OptionGroups> {
  using Scalar = OptionGroup;
  static constexpr bool list = false;
  static constexpr bool automatic = false;
};

template <class V>
concept OptionInteger = std::integral<V> && !std::same_as<V, bool>;
template <class V>
concept OptionEnum = std::is_enum_v<V>;

template <class V>
using ChoiceTable = std::vector<std::pair<std::string, V>>;

template <class V>
constexpr OptionType option_type() {
  if constexpr (std::same_as<V, bool>)
    return OptionType::boolean;
  else if constexpr (OptionInteger<V>)
    return OptionType::integer;
  else if constexpr (std::floating_point<V>)
    return OptionType::number;
  else if constexpr (OptionEnum<V>)
    return OptionType::choice;
  else if constexpr (std::same_as<V, std::filesystem::path>)
    return OptionType::path;
  else if constexpr (std::same_as<V, OptionGroup>)
    return OptionType::groups;
  else {
    static_assert(std::same_as<V, std::string>, "an option of this type cannot be read from YAML");
    return OptionType::text;
  }
}

template <class V>
OptionScalar to_scalar(const V& value, const ChoiceTable<V>& table) {
  if constexpr (std::same_as<V, bool> || std::same_as<V, std::string>)
    return value;
  else if constexpr (OptionInteger<V>)
    return static_cast<std::int64_t>(value);
  else if constexpr (std::floating_point<V>)
    return static_cast<double>(value);
  else if constexpr (OptionEnum<V>) {
    for (const auto& [name, choice] : table) {
      if (choice == value) return name;
    }
    return std::string("?");
  } else
    return value.string();
}

template <class V>
V from_scalar(const OptionScalar& scalar, const ChoiceTable<V>& table) {
  if constexpr (std::same_as<V, bool>)
    return std::get<bool>(scalar);
  else if constexpr (OptionInteger<V>)
    return static_cast<V>(std::get<std::int64_t>(scalar));
  else if constexpr (std::floating_point<V>)
    return static_cast<V>(std::get<double>(scalar));
  else if constexpr (OptionEnum<V>) {
    for (const auto& [name, choice] : table) {
      if (name == std::get<std::string>(scalar)) return choice;
    }
    return V{};  // not reached: complaint() has refused other names
  } else
    return V(std::get<std::string>(scalar));
}

}  // namespace detail

/// Properties of an option beyond its name and help. V is the type of its values.
template <class V>
class OptionDeclaration {
 public:
  /// For OptionSet::add, which makes them.
  OptionDeclaration(Option& option, std::shared_ptr<detail::ChoiceTable<V>> table)
      : option_(&option), table_(std::move(table)) {}

  /// The SI unit that a plain number is in; `5cm` and the like are converted to it, other units refused.
  OptionDeclaration& unit(std::string unit) {
    option_->unit = std::move(unit);
    return *this;
  }
  /// Smallest and largest number, both allowed, in the option's unit.
  OptionDeclaration& range(double min, double max) {
    option_->min = min;
    option_->max = max;
    return *this;
  }
  /// Smallest number, allowed, in the option's unit.
  OptionDeclaration& at_least(double min) {
    option_->min = min;
    return *this;
  }
  /// Shortest and longest list.
  OptionDeclaration& count(std::size_t min, std::size_t max) {
    option_->min_count = min;
    option_->max_count = max;
    return *this;
  }
  /// There is no default: a pipeline that does not give it is wrong.
  OptionDeclaration& required() {
    option_->required = true;
    return *this;
  }
  /// Marks the path of a file that the stage writes instead of reading it: a pipeline in which another stage
  /// reads or writes it is an error.
  /// @param also  further files that the stage writes, named after it: "<stem>_####<ext>" are
  ///              cloud_0001.pcd, cloud_0002.pcd … of cloud.pcd; # is any digit, * any text
  OptionDeclaration& writes(
      const std::vector<std::string_view>& also = {}) requires std::same_as<V, std::filesystem::path> {
    option_->writes = {kFileItself};
    option_->writes.insert(option_->writes.end(), also.begin(), also.end());
    return *this;
  }
  /// The path's extension, in small letters or capitals: ".pcd". A file with another one would be taken for
  /// what it is not.
  OptionDeclaration& ending(std::string extension) requires std::same_as<V, std::filesystem::path> {
    option_->ending = std::move(extension);
    return *this;
  }
  /// The path is of a folder that the stage writes such files into: "*_noise.svg". As above, no other stage
  /// may read or write them.
  OptionDeclaration& writes_into(
      const std::vector<std::string_view>& files) requires std::same_as<V, std::filesystem::path> {
    option_->is_folder = true;
    option_->writes.assign(files.begin(), files.end());
    return *this;
  }
  /// The names of an enumeration's values; every enumeration needs them.
  OptionDeclaration& choices(
      std::initializer_list<std::pair<std::string_view, V>> table) requires detail::OptionEnum<V> {
    for (const auto& [name, value] : table) {
      table_->emplace_back(name, value);
      option_->choices.emplace_back(name);
    }
    return *this;
  }
  /// All the texts that are allowed.
  OptionDeclaration& choices(
      std::initializer_list<std::string_view> texts) requires std::same_as<V, std::string> {
    option_->choices.assign(texts.begin(), texts.end());
    return *this;
  }

 private:
  Option* option_;
  std::shared_ptr<detail::ChoiceTable<V>> table_;
};

/// The options of a struct or class T, each declared once:
///
///     OptionSet<Rqe> options;
///     options.add("sigma", &Rqe::sigma, "kernel width; start well above the noise")
///         .unit("m").range(1e-4, 10);
///
/// Between name and help stands the way from T to the member: one pointer to a member or callable, or a chain
/// of up to three. Members can be bool, integers, double, float, std::string, std::filesystem::path,
/// enumerations, a std::vector of these, or a std::optional of these (whose absence is written `auto`); or
/// OptionGroups. An option "motion.kind" is one of the group `motion`, a map in YAML: `motion: {kind:
/// varying}`.
template <class T>
class OptionSet {
 public:
  /// Declares an option of a member. @param a  pointer to the member, or a callable that returns a reference
  /// to it
  template <class A>
  auto add(std::string name, A a, std::string help) {
    return declare(
        std::move(name), std::move(help), [a](T & object) -> auto& { return std::invoke(a, object); });
  }
  /// Declares an option of a member of a member: `a` of T, then `b` of that.
  template <class A, class B>
  auto add(std::string name, A a, B b, std::string help) {
    return declare(
        std::move(name), std::move(help),
        [ a, b ](T & object) -> auto& { return std::invoke(b, std::invoke(a, object)); });
  }
  /// Declares an option three members deep.
  template <class A, class B, class C>
  auto add(std::string name, A a, B b, C c, std::string help) {
    return declare(
        std::move(name), std::move(help),
        [ a, b, c ](T & object) -> auto& { return std::invoke(c, std::invoke(b, std::invoke(a, object))); });
  }

  /// All declared options, in the order of declaration.
  const std::deque<Option>& all() const { return options_; }

 private:
  template <class Access>
  auto declare(std::string name, std::string help, Access access) {
    using Value = std::remove_cvref_t<std::invoke_result_t<Access, T&>>;
    using Shape = detail::ValueShape<Value>;
    using V = typename Shape::Scalar;
    auto table = std::make_shared<detail::ChoiceTable<V>>();

    Option option;
    option.name = std::move(name);
    option.help = std::move(help);
    option.type = detail::option_type<V>();
    option.list = Shape::list;
    option.may_be_auto = Shape::automatic;
    if constexpr (detail::OptionInteger<V>) {
      option.min = static_cast<double>(std::numeric_limits<V>::min());
      option.max = static_cast<double>(std::numeric_limits<V>::max());
    }
    option.set = [access, table](void* object, const OptionValue& value) {
      access(*static_cast<T*>(object)) = convert<Value>(value, *table);
    };
    option.get = [access, table](const void* object) -> OptionValue {
      // The access only reads here; one accessor serves both directions because T is never a const object.
      return describe(access(*const_cast<T*>(static_cast<const T*>(object))), *table);
    };
    options_.push_back(std::move(option));
    return OptionDeclaration<V>(options_.back(), std::move(table));
  }

  template <class Value, class Table>
  static Value convert(const OptionValue& value, const Table& table) {
    using Shape = detail::ValueShape<Value>;
    using V = typename Shape::Scalar;
    if constexpr (std::same_as<Value, OptionGroups>) {
      return std::get<OptionGroups>(value);
    } else if constexpr (Shape::list) {
      Value list;
      for (const auto& scalar : std::get<std::vector<OptionScalar>>(value)) {
        list.push_back(detail::from_scalar<V>(scalar, table));
      }
      return list;
    } else if constexpr (Shape::automatic) {
      if (std::holds_alternative<std::monostate>(value)) return std::nullopt;
      return detail::from_scalar<V>(std::get<OptionScalar>(value), table);
    } else {
      return detail::from_scalar<V>(std::get<OptionScalar>(value), table);
    }
  }

  template <class Value, class Table>
  static OptionValue describe(const Value& value, const Table& table) {
    using Shape = detail::ValueShape<Value>;
    using V = typename Shape::Scalar;
    if constexpr (std::same_as<Value, OptionGroups>) {
      return value;
    } else if constexpr (Shape::list) {
      std::vector<OptionScalar> list;
      for (const V& element : value) list.push_back(detail::to_scalar<V>(element, table));
      return list;
    } else if constexpr (Shape::automatic) {
      if (!value) return std::monostate{};
      return detail::to_scalar<V>(*value, table);
    } else {
      return detail::to_scalar<V>(value, table);
    }
  }

  std::deque<Option> options_;  // a deque: declarations keep references while it grows
};

}  // namespace crisp
