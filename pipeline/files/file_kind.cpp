// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/files/file_kind.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace crisp::files {
namespace {

bool has_any(const YamlNode& map, std::initializer_list<std::string_view> keys) {
  return std::ranges::any_of(keys, [&](std::string_view key) { return map.find(key) != nullptr; });
}

/// A rig has these within `nominal`, and plain values of them even where that was forgotten.
bool is_calibrated(const YamlEntry& laser) {
  return std::ranges::any_of(laser.value.entries, [](const YamlEntry& entry) {
    constexpr std::array<std::string_view, 5> kKeys = {"lambda", "tau", "alpha", "eta", "terms"};
    return entry.value.kind == YamlNode::Kind::map && std::ranges::find(kKeys, entry.key) != kKeys.end();
  });
}

const char* in_words(FileKind kind) {
  constexpr std::array kWords = {"unknown", "a pipeline", "a rig", "a calibration"};
  return kWords.at(static_cast<std::size_t>(kind));
}

/// How to come by a file of the kind that is wanted, or where the one that is there belongs.
const char* advice_on(FileKind is, FileKind requested) {
  if (requested == FileKind::calibration) return "configs/calibrate.yaml makes a calibration";
  if (requested == FileKind::rig) return "configs/rig.yaml is a rig";
  return is == FileKind::rig ? "give it with --rig; configs/calibrate.yaml is a pipeline"
                             : "calibrate.load reads it; configs/calibrate.yaml is a pipeline";
}

}  // namespace

FileKind kind_of(const YamlNode& root) {
  if (root.find("pipeline")) return FileKind::pipeline;
  const YamlNode* lasers = root.find("lasers");
  if (!lasers) return FileKind::unknown;
  const bool calibration = has_any(root, {"covariance", "quality", "provenance"}) ||
                           std::ranges::any_of(lasers->entries, is_calibrated);
  return calibration ? FileKind::calibration : FileKind::rig;
}

void refuse_other_kinds(const YamlNode& root, const std::filesystem::path& file, FileKind requested) {
  const FileKind is = kind_of(root);
  if (is == requested || is == FileKind::unknown) return;
  throw Error(fmt::format("{} is {}, not {}", file.string(), in_words(is), in_words(requested)),
              advice_on(is, requested));
}

}  // namespace crisp::files
