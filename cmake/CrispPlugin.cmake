# SPDX-License-Identifier: BSD-3-Clause
# crisp_add_plugin(<name> SOURCES ... [LIBRARIES ...]) makes the plugin <name>.so: stages, terms, measures or
# searches that `crisp` loads by --plugin or CRISP_PLUGINS, or, once installed, from
# <libdir>/crisp/plugins. One of the sources holds CRISP_PLUGIN(...) of crisp/plugin.hpp.
function(crisp_add_plugin name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;LIBRARIES")
  if(arg_UNPARSED_ARGUMENTS OR NOT arg_SOURCES)
    message(FATAL_ERROR "crisp_add_plugin(<name> SOURCES ... [LIBRARIES ...])")
  endif()
  add_library(${name} MODULE ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE crisp::stage ${arg_LIBRARIES})
  # Missing symbols are reported by the linker, not when a user loads the plugin.
  target_link_options(${name} PRIVATE -Wl,--no-undefined)
  set_target_properties(${name} PROPERTIES PREFIX "" CXX_EXTENSIONS OFF INSTALL_RPATH "$ORIGIN/../..")
  include(GNUInstallDirs)
  install(TARGETS ${name} LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}/crisp/plugins")
endfunction()
