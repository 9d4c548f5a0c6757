// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "pipeline/quality/surfels.hpp"

namespace crisp::estimate {

/// The flat surfaces against which a refinement measures its beams: segmented anew while the parameters still
/// move, and kept in the end, so that the refinement's steps converge.
class FlatSurfaces {
 public:
  virtual ~FlatSurfaces() = default;

  /// One more round, with the beams where the parameters now put them.
  ///
  /// @param is_moving  whether the parameters move so far yet that surfaces may be others
  virtual const quality::Surfels& update(const quality::BeamsView& beams, bool is_moving) = 0;

  /// Whether it has ended to choose which beams belong to which surface.
  virtual bool is_settled() const = 0;
};

/// Patches and walls that beams of a full field of view see: see find_surfels().
///
/// @param searches  rounds after which they are kept, at the latest
/// @param swept     whether each view sees areas; beams that do not sweep see lines, whose own planes are not
/// the walls'
/// @param known     surfaces of swept beams to begin with, from a model near the start. They replace the
/// searches while the parameters move, unless the final ones hold many more beams; none: searched for
std::unique_ptr<FlatSurfaces> patches(const quality::SurfelSettings& settings, int searches,
                                      bool swept = true, quality::Surfels known = {});

/// Upright walls that beams in the plate's plane see as lines: see wall_lines().
std::unique_ptr<FlatSurfaces> upright_walls(const quality::SurfelSettings& settings, int searches);

}  // namespace crisp::estimate
