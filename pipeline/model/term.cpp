// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <set>

#include <crisp/error.hpp>
#include <crisp/term.hpp>

#include "pipeline/data/name_syntax.hpp"
#include "pipeline/files/nearest.hpp"

namespace crisp {
namespace {

auto find(const std::vector<std::shared_ptr<const ModelTerm>>& terms, const std::string& name) {
  return std::find_if(terms.begin(), terms.end(),
                      [&](const auto& term) { return term->info().name == name; });
}

void check(const TermInfo& info) {
  if (!data::is_name_in_family(info.name)) {
    throw Error("'" + info.name + "' is not a model term's name", "write family.name, of a-z, 0-9 and _");
  }
  std::set<std::string> seen;
  for (const EffectParameter& parameter : info.parameters) {
    const auto fail = [&](const std::string& what) {
      throw Error(
          "the model term " + info.name + " declares its parameter '" + parameter.name + "' wrongly: " + what,
          "correct the parameter in the term's info()");
    };
    if (!data::is_symbol(parameter.name)) fail("names are of letters, digits and _");
    if (!seen.insert(parameter.name).second) fail("it is declared twice");
    if (parameter.unit.empty()) fail("it has no unit; that of a plain number is 1");
    if (!(parameter.lower <= parameter.neutral && parameter.neutral <= parameter.upper)) {
      fail("its neutral value is not within its bounds");
    }
  }
}

}  // namespace

void TermRegistry::add(std::shared_ptr<const ModelTerm> term) {
  check(term->info());
  const std::string& name = term->info().name;
  if (knows(name)) throw Error("the model term " + name + " is registered twice", "rename one of the two");
  terms_.push_back(std::move(term));
}

std::shared_ptr<const ModelTerm> TermRegistry::get(const std::string& name) const {
  const auto found = find(terms_, name);
  if (found != terms_.end()) return *found;
  throw Error("there is no term " + name + " of the sensor model",
              files::did_you_mean(name, names(), "`crisp effects` lists the effects"));
}

bool TermRegistry::knows(const std::string& name) const { return find(terms_, name) != terms_.end(); }

std::vector<std::string> TermRegistry::names() const {
  std::vector<std::string> names;
  for (const auto& term : terms_) names.push_back(term->info().name);
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace crisp
