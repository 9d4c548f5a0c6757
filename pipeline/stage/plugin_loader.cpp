// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/stage/plugin_loader.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <system_error>

#include "pipeline/stage/plugin.hpp"

namespace crisp {
namespace {

namespace fs = std::filesystem;

/// Why a descriptor cannot be used, or nothing if it can.
std::string refusal_of(const PluginDescriptor& descriptor) {
  if (descriptor.size != sizeof(PluginDescriptor)) {
    return fmt::format(
        "its descriptor has {} bytes where this program's has {}: built for another version of crisp; "
        "rebuild "
        "it against this one",
        descriptor.size, sizeof(PluginDescriptor));
  }
  if (!descriptor.abi_key || !descriptor.name || !descriptor.version || !descriptor.register_all) {
    return "its descriptor is incomplete";
  }
  if (descriptor.abi_key != std::string(CRISP_ABI_KEY)) {
    return fmt::format(
        "it was built for '{}', and this program is '{}'; rebuild it against this crisp with the same "
        "compiler "
        "flags",
        descriptor.abi_key, CRISP_ABI_KEY);
  }
  return {};
}

std::string last_error() {
  const char* text = dlerror();
  return text ? text : "it cannot be loaded";
}

/// What a plugin throws while it registers itself, in words; empty if nothing.
template <class Register>
std::string what_is_wrong_with(Register register_all) {
  try {
    register_all();
    return {};
  } catch (const Error& error) {
    return error.message();
  } catch (const std::exception& error) {
    return std::string("what it registers was refused: ") + error.what();
  } catch (...) {
    return "registering its stages it threw what is no std::exception";
  }
}

}  // namespace

void PluginLoader::load(const fs::path& file_or_folder) {
  std::error_code failure;
  if (!fs::is_directory(file_or_folder, failure)) return load_file(file_or_folder);
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(file_or_folder, failure)) {
    if (entry.path().extension() == ".so") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  for (const auto& file : files) load_file(file);
}

void PluginLoader::load_file(const fs::path& file) {
  PluginRecord& record = tried_.emplace_back();
  record.file = fs::absolute(file).lexically_normal();
  void* handle = dlopen(record.file.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  if (!handle) {
    record.refusal = last_error();
    return;
  }
  const auto* descriptor = static_cast<const PluginDescriptor*>(dlsym(handle, "crisp_plugin"));
  record.refusal =
      descriptor ? refusal_of(*descriptor) : "it has no symbol crisp_plugin: it is no plugin of crisp";
  if (!record.is_loaded()) return;
  record.name = descriptor->name;
  record.version = descriptor->version;

  const auto before = registrar_.registered();
  const auto take_back = registrar_.snapshot();
  const std::string origin = registrar_.origin();
  registrar_.set_origin("from " + record.file.string());
  record.refusal = what_is_wrong_with([&] { descriptor->register_all(registrar_); });
  registrar_.set_origin(origin);
  if (!record.is_loaded()) return take_back();
  std::ranges::set_difference(registrar_.registered(), before, std::back_inserter(record.brings));
}

}  // namespace crisp
