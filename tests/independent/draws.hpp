// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace independent {

/// Named random draws, each from a stream of its own.
///
/// A draw depends on the seed and its name only, so that fixing one draw (`scene=office`) changes no other.
/// A name such as `kind.2` is fixed by `kind.2=…`, or for all lasers by `kind=…`.
class Draws {
 public:
  struct Weighted {
    std::string value;
    double weight;
  };

  Draws(std::uint64_t seed, std::map<std::string, std::string> fixed);

  double uniform(const std::string& name, double low, double high);
  double log_uniform(const std::string& name, double low, double high);
  /// Normal draw of mean 0, redrawn until it lies within `limit` standard deviations.
  double truncated_normal(const std::string& name, double sd, double limit);
  int integer(const std::string& name, int low, int high);   ///< both ends included
  bool chance(const std::string& name, double probability);  ///< fixed by 0 or 1
  /// @throws std::runtime_error  if the draw is fixed to a value that is none of `values`
  std::string choice(const std::string& name, const std::vector<Weighted>& values);

  bool is_fixed(const std::string& name) const { return fixed_.contains(name); }
  std::mt19937_64 stream(const std::string& name) const;
  std::uint64_t seed() const { return seed_; }

  /// @throws std::runtime_error  if a fixed draw has a name that nothing has drawn
  void require_all_used() const;

 private:
  const std::string* fixed(const std::string& name);

  std::uint64_t seed_;
  std::map<std::string, std::string> fixed_;
  std::set<std::string> used_;
};

}  // namespace independent
