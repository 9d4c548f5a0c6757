// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/batch/slurm_environment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>

#include <crisp/error.hpp>

namespace crisp::batch {
namespace {

template <class Number>
std::optional<Number> whole_number_of(const char* text) {
  if (!text) return std::nullopt;
  const std::string_view digits(text);
  Number number = 0;
  const auto [end, failure] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (failure != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
  return number;
}

}  // namespace

std::optional<Shard> shard_of_slurm(EnvironmentVariable variable) {
  const auto number = [&](const char* name) { return whole_number_of<std::uint64_t>(variable(name)); };
  const auto id = number("SLURM_ARRAY_TASK_ID");
  if (!id) return std::nullopt;
  const std::uint64_t least = number("SLURM_ARRAY_TASK_MIN").value_or(*id);
  const std::uint64_t step = number("SLURM_ARRAY_TASK_STEP").value_or(1);
  const std::uint64_t count = number("SLURM_ARRAY_TASK_COUNT").value_or(1);
  const Shard shard{.number = (*id - least) / std::max<std::uint64_t>(step, 1) + 1, .count = count};
  if (*id >= least && shard.number <= count) return shard;
  throw Error(
      fmt::format(
          "the share of task {} of the Slurm array is undetermined: the array begins at {} and has {} tasks",
          *id, least, count),
      "use an array without gaps, or give --shard i/n");
}

std::optional<unsigned> cores_of_slurm(EnvironmentVariable variable) {
  const auto cores = whole_number_of<unsigned>(variable("SLURM_CPUS_ON_NODE"));
  return cores && *cores > 0 ? cores : std::nullopt;
}

}  // namespace crisp::batch
