// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/model/term.hpp"

#include <algorithm>

#include "pipeline/data/error.hpp"
#include "pipeline/files/nearest.hpp"

namespace crisp {
namespace {

auto find(const std::vector<std::shared_ptr<const ModelTerm>>& terms, const std::string& name) {
  return std::find_if(terms.begin(), terms.end(),
                      [&](const auto& term) { return term->info().name == name; });
}

}  // namespace

void TermRegistry::add(std::shared_ptr<const ModelTerm> term) {
  const std::string& name = term->info().name;
  if (knows(name)) throw Error("the model term " + name + " is registered twice", "rename one of the two");
  terms_.push_back(std::move(term));
}

std::shared_ptr<const ModelTerm> TermRegistry::get(const std::string& name) const {
  const auto found = find(terms_, name);
  if (found != terms_.end()) return *found;
  throw Error("there is no term " + name + " of the sensor model",
              did_you_mean(name, names(), "`crisp effects` lists those that there are"));
}

bool TermRegistry::knows(const std::string& name) const { return find(terms_, name) != terms_.end(); }

std::vector<std::string> TermRegistry::names() const {
  std::vector<std::string> names;
  for (const auto& term : terms_) names.push_back(term->info().name);
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace crisp
