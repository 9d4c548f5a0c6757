// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace crisp::test {

/// Where a type that the linker can see is defined.
struct NamedType {
  std::string name;  ///< with its namespaces: "crisp::simd::PairKernel"
  int line = 0;
};

/// Types that a C++ source defines in named namespaces: no forward declarations, no specialisations, nothing
/// inside another type, a function or an anonymous namespace. It reads words and braces, not C++: enough for
/// sources that a compiler accepts.
std::vector<NamedType> named_types(std::string_view source);

}  // namespace crisp::test
