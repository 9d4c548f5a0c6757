// SPDX-License-Identifier: BSD-3-Clause
#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <system_error>

#include <crisp/plugin.hpp>
#include <crisp/plugin_loader.hpp>

#include "pipeline/stage/plugin_check.hpp"

namespace crisp {
namespace {

namespace fs = std::filesystem;

/// Why a descriptor cannot be used, or nothing if it can.
std::string refusal_of(const PluginDescriptor& descriptor) {
  if (descriptor.size != sizeof(PluginDescriptor)) {
    return fmt::format(
        "its descriptor has {} bytes where this program's has {}: built for another version of crisp; rebuild it against this one",
        descriptor.size, sizeof(PluginDescriptor));
  }
  if (!descriptor.abi_key || !descriptor.name || !descriptor.version || !descriptor.register_all) {
    return "its descriptor is incomplete";
  }
  if (descriptor.abi_key != std::string(CRISP_ABI_KEY)) {
    return fmt::format(
        "it was built for '{}', and this program is '{}'; rebuild it against this crisp with the same compiler flags",
        descriptor.abi_key, CRISP_ABI_KEY);
  }
  return {};
}

std::string last_error() {
  const char* text = dlerror();
  return text ? text : "it cannot be loaded";
}

/// The exception of a plugin's registration, in words; empty without one.
template <class Register>
std::string what_is_wrong_with(Register register_all) {
  try {
    register_all();
    return {};
  } catch (const Error& error) {
    return error.advice().empty() ? error.message() : error.message() + "; " + error.advice();
  } catch (const std::exception& error) {
    return std::string("its registration was rejected: ") + error.what();
  } catch (...) {
    return "its registration threw something that is no std::exception";
  }
}

/// The file itself, or the *.so of a folder in the order of their names.
std::vector<fs::path> plugin_files(const fs::path& file_or_folder) {
  std::error_code failure;
  std::vector<fs::path> files;
  if (!fs::is_directory(file_or_folder, failure)) {
    files.push_back(file_or_folder);
  } else {
    for (const auto& entry : fs::directory_iterator(file_or_folder, failure)) {
      if (entry.path().extension() == ".so") files.push_back(entry.path());
    }
    std::ranges::sort(files);
  }
  for (auto& file : files) file = fs::absolute(file).lexically_normal();
  return files;
}

/// Whether every text of a descriptor can be read.
std::size_t length_of_texts(const PluginDescriptor& descriptor) {
  std::size_t length = 0;
  for (const char* text : {descriptor.abi_key, descriptor.name, descriptor.version})
    length += std::strlen(text);
  return length;
}

/// Opens a plugin without calling anything of it.
/// @return its descriptor; nullptr, and why in `refusal`, if it cannot be used
const PluginDescriptor* open_sound_plugin(const fs::path& file, std::string& refusal) {
  void* handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  if (!handle) {
    refusal = last_error();
    return nullptr;
  }
  const auto* descriptor = static_cast<const PluginDescriptor*>(dlsym(handle, "crisp_plugin"));
  refusal = descriptor ? refusal_of(*descriptor) : "it has no symbol crisp_plugin: it is no plugin of crisp";
  return refusal.empty() ? descriptor : nullptr;
}

/// The same of any file, be it damaged: it is loaded, and has registered what it brings, in a process of its
/// own first.
const PluginDescriptor* open_plugin(const fs::path& file, Registrar& registrar, std::string& refusal) {
  refusal = stage::fault_of_object(file);
  if (!refusal.empty()) return nullptr;
  const std::string crash = stage::crash_of([&] {
    std::string ignored;
    const auto* descriptor = open_sound_plugin(file, ignored);
    if (!descriptor || length_of_texts(*descriptor) == 0) return;
    what_is_wrong_with([&] { descriptor->register_all(registrar); });
  });
  if (crash.empty()) return open_sound_plugin(file, refusal);
  refusal = "it is damaged: a process that loads it ends " + crash + "; copy or build it again";
  return nullptr;
}

bool is_same_file(const fs::path& one, const fs::path& other) {
  std::error_code unknown;
  return fs::equivalent(one, other, unknown);
}

}  // namespace

void PluginLoader::prefer(const fs::path& file_or_folder) {
  for (const auto& file : plugin_files(file_or_folder)) {
    std::string refusal;
    if (const auto* descriptor = open_plugin(file, registrar_, refusal))
      preferred_.try_emplace(descriptor->name, file);
  }
}

void PluginLoader::load(const fs::path& file_or_folder) {
  for (const auto& file : plugin_files(file_or_folder)) load_file(file);
}

void PluginLoader::load_file(const fs::path& file) {
  PluginRecord record{.file = file};
  if (const auto* descriptor = open_plugin(file, registrar_, record.refusal)) {
    record.name = descriptor->name;
    record.version = descriptor->version;
    judge_name(record);
    if (record.is_loaded()) record.warning = stage::exposure_of(file);
    if (record.is_loaded()) register_all(record, *descriptor);
  }
  tried_.push_back(std::move(record));
}

/// Whether the plugin is in use from another file, or will be.
void PluginLoader::judge_name(PluginRecord& record) const {
  const auto preferred = preferred_.find(record.name);
  if (preferred != preferred_.end() && !is_same_file(preferred->second, record.file)) {
    record.skipped = preferred->second.string();
    return;
  }
  const auto is_the_same = [&](const auto& other) { return other.is_loaded() && other.name == record.name; };
  const auto before = std::ranges::find_if(tried_, is_the_same);
  if (before != tried_.end()) record.skipped = before->file.string();
}

void PluginLoader::register_all(PluginRecord& record, const PluginDescriptor& descriptor) {
  const auto before = registrar_.registered();
  const auto take_back = registrar_.snapshot();
  const std::string origin = registrar_.origin();
  registrar_.set_origin("from " + record.file.string());
  record.refusal = what_is_wrong_with([&] { descriptor.register_all(registrar_); });
  registrar_.set_origin(origin);
  if (!record.is_loaded()) return take_back();
  std::ranges::set_difference(registrar_.registered(), before, std::back_inserter(record.brings));
}

}  // namespace crisp
