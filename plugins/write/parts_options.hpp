// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <string_view>

#include <crisp/context.hpp>
#include <crisp/stage.hpp>

#include "pipeline/pcd/parts.hpp"

namespace crisp::write {

/// How PCD files are written, and where a long recording is cut into several.
struct PartsOptions {
  std::filesystem::path file;
  PcdFormat format = PcdFormat::binary_compressed;
  std::size_t split_points = 5'000'000;  // some 600 MB of memory while a file is being written
  std::optional<double> split_duration;  ///< [s]

  /// Whether a part of so many points, the first at `begin`, is full before a point at `time` [s].
  bool is_full(std::size_t points, double begin, double time) const {
    return points >= split_points ||
           time - begin >= split_duration.value_or(std::numeric_limits<double>::infinity());
  }
};

/// @param also  files written next to the parts, see OptionDeclaration::writes
template <class S>
void describe_parts(StageDescription<S>& d, PartsOptions S::*options,
                    std::initializer_list<std::string_view> also = {}) {
  std::vector<std::string_view> files = {"<stem>_####<ext>"};
  files.insert(files.end(), also.begin(), also.end());
  d.option("file", options, &PartsOptions::file, "output file, NAME.pcd")
      .writes(files)
      .ending(".pcd")
      .required();
  d.option("format", options, &PartsOptions::format, "encoding of the points")
      .choices({{"binary_compressed", PcdFormat::binary_compressed},
                {"binary", PcdFormat::binary},
                {"ascii", PcdFormat::ascii}});
  d.option("split_points", options, &PartsOptions::split_points,
           "maximum number of points in one file; more are split into NAME_0001.pcd, NAME_0002.pcd and so on")
      .range(1, 1e8);
  d.option("split_duration", options, &PartsOptions::split_duration,
           "maximum duration of one file; auto: no limit")
      .unit("s")
      .range(1e-3, 1e9);
}

/// Reports removed files of an earlier run.
void report_removed(const std::vector<std::filesystem::path>& files, Context& context);

/// Moves the files to their place, removes those of an earlier run under the same name, and registers the
/// files with the run.
/// @param what they hold, for people: "points"
void finish_parts(pcd::PartsWriter& writer, std::size_t count, std::string_view what, Context& context);

}  // namespace crisp::write
