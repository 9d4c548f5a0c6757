// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <crisp/error.hpp>

namespace crisp {

/// Things of one kind that are made by name: the built-in ones and those of plugins.
template <class T, class... Settings>
class Registry {
 public:
  /// Makes a new object with the given settings.
  using Factory = std::function<std::unique_ptr<T>(const Settings&...)>;

  /// @param summary  what it is, in half a sentence
  /// @throws Error   if the name is taken
  void add(const std::string& name, std::string summary, Factory make) {
    if (!entries_.emplace(name, Entry{std::move(summary), std::move(make)}).second) {
      throw Error("\"" + name + "\" is registered twice", "give one of the two another name");
    }
  }

  /// @throws Error naming what is known, if this is not
  std::unique_ptr<T> make(const std::string& name, const Settings&... settings) const {
    return entry(name).make(settings...);
  }
  /// @throws Error  as make()
  const std::string& summary(const std::string& name) const { return entry(name).summary; }

  /// All known names, in alphabetical order.
  std::vector<std::string> names() const {
    std::vector<std::string> result;
    for (const auto& [name, entry] : entries_) result.push_back(name);
    return result;
  }

 private:
  struct Entry {
    std::string summary;
    Factory make;
  };

  const Entry& entry(const std::string& name) const {
    const auto found = entries_.find(name);
    if (found != entries_.end()) return found->second;
    std::string known;
    for (const auto& other : names()) known += (known.empty() ? "" : ", ") + other;
    throw Error("there is no \"" + name + "\"", "known are: " + known);
  }

  std::map<std::string, Entry> entries_;
};

}  // namespace crisp
