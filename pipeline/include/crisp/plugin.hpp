// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include <crisp/registrar.hpp>

// ABI key: a plugin and the program that loads it must agree in it. Types of the standard
// library and of Eigen cross the boundary, and their layout depends on these. Spelt by the preprocessor, so
// that it is a constant in the plugin's file and can be read before anything of the plugin runs.
#define CRISP_TEXT_OF(x) #x
#define CRISP_TEXT(x) CRISP_TEXT_OF(x)
#if defined(__clang__)
#define CRISP_COMPILER "clang-" CRISP_TEXT(__clang_major__)
#elif defined(__GNUC__)
#define CRISP_COMPILER "gcc-" CRISP_TEXT(__GNUC__)
#else
#define CRISP_COMPILER "unknown"
#endif
#define CRISP_ABI_KEY                                                                    \
  CRISP_COMPILER " cxx11_abi=" CRISP_TEXT(_GLIBCXX_USE_CXX11_ABI) " c++abi=" CRISP_TEXT( \
      __GXX_ABI_VERSION) " eigen_align=" CRISP_TEXT(EIGEN_MAX_ALIGN_BYTES) " crisp=" CRISP_VERSION

namespace crisp {

/// Content of a plugin's one symbol, `crisp_plugin`: a constant, not a function.
struct PluginDescriptor {
  std::uint32_t size;                ///< sizeof(PluginDescriptor) where the plugin was compiled
  const char* abi_key;               ///< CRISP_ABI_KEY where the plugin was compiled
  const char* name;                  ///< "example"
  const char* version;               ///< the plugin's own
  void (*register_all)(Registrar&);  ///< the first code of the plugin that is called
};

}  // namespace crisp

/// Once in a plugin, at namespace scope: CRISP_PLUGIN("example", "1.0", register_example)
#define CRISP_PLUGIN(name, version, register_all)                                                     \
  extern "C" __attribute__((visibility("default"))) const crisp::PluginDescriptor crisp_plugin;       \
  const crisp::PluginDescriptor crisp_plugin = {sizeof(crisp::PluginDescriptor), CRISP_ABI_KEY, name, \
                                                version, register_all}
