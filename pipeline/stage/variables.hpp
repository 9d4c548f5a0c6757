// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "pipeline/files/yaml.hpp"

namespace crisp::stage {

/// The variables of a pipeline: what `${name}` stands for.
class Variables {
 public:
  /// A variable and its value, which may be a list or map where `${name}` stands alone.
  void set(const std::string& name, files::YamlNode value) { values_[name] = std::move(value); }
  void set(const std::string& name, const std::string& text);
  /// A variable that is known but has no value in this run; `advice` states how to set it.
  void set_missing(const std::string& name, std::string advice) { missing_[name] = std::move(advice); }
  bool contains(const std::string& name) const { return values_.contains(name); }

  /// Replaces each `${name}` in every scalar of the tree, once: substituted text is not searched again.
  /// `$${` stands for `${`. Adds an error for each name that is not known.
  /// @throws Error  once more than a mebibyte has been substituted: variables that double one another grow
  /// without end
  void substitute(files::YamlNode& node, std::vector<Error>& errors);

 private:
  void substitute_scalar(files::YamlNode& node, std::vector<Error>& errors);
  void count(const files::YamlNode& value, const Place& place);
  const files::YamlNode* find(const std::string& name, const Place& place, std::vector<Error>& errors) const;

  std::map<std::string, files::YamlNode> values_;
  std::map<std::string, std::string> missing_;
  std::size_t put_in_ = 0;  ///< characters and nodes
};

}  // namespace crisp::stage
