// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/built_in.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include <crisp/error.hpp>

#include "pipeline/files/nearest.hpp"

namespace crisp::simulate {

std::vector<std::string> names_of(std::span<const BuiltIn> all) {
  std::vector<std::string> names;
  for (const BuiltIn& one : all) names.emplace_back(one.name);
  return names;
}

std::string_view text_of(std::span<const BuiltIn> all, std::string_view kind, const std::string& name) {
  const auto found = std::ranges::find(all, name, &BuiltIn::name);
  if (found != all.end()) return found->yaml;
  const std::vector<std::string> names = names_of(all);
  throw Error(fmt::format("there is no {} '{}'", kind, name),
              files::did_you_mean(name, names, fmt::format("known are {}", fmt::join(names, ", "))));
}

}  // namespace crisp::simulate
