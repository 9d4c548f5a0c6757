// SPDX-License-Identifier: BSD-3-Clause
// A plugin that another compiler could have made: nothing of it may be called.
#include <cstdlib>

#include <crisp/plugin.hpp>

namespace {
void never_called(crisp::Registrar&) { std::abort(); }
}  // namespace

extern "C" const crisp::PluginDescriptor crisp_plugin;
const crisp::PluginDescriptor crisp_plugin = {sizeof(crisp::PluginDescriptor),
                                              "gcc-4 cxx11_abi=0 eigen_align=16 crisp=0.0.1", "foreign", "1",
                                              never_called};
