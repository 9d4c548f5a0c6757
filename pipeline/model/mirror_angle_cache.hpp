// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <vector>

#include "pipeline/model/base_kinematics.hpp"

namespace crisp {

/// Sines and cosines of mirror angles that were met, kept from scan to scan: a laser's are mostly the same in
/// each. For one who places scan after scan; not from several threads at once.
class KnownMirrors {
 public:
  /// The cached values of a laser, with room for the beams numbered below `beams`. Valid until the next call.
  simd::MirrorTable of(std::size_t laser, std::size_t beams) {
    if (tables_.size() <= laser) tables_.resize(laser + 1);
    Table& own = tables_[laser];
    if (own.angle.size() < beams) {
      own.angle.resize(beams, std::numeric_limits<float>::quiet_NaN());  // equal to no angle
      own.sine.resize(beams);
      own.cosine.resize(beams);
    }
    return {own.angle.data(), own.sine.data(), own.cosine.data(), own.angle.size()};
  }

 private:
  struct Table {
    std::vector<float> angle;
    std::vector<double> sine;
    std::vector<double> cosine;
  };
  std::vector<Table> tables_;  // by laser
};

}  // namespace crisp
