// SPDX-License-Identifier: BSD-3-Clause
#include "tests/independent/draws.hpp"

#include <cmath>
#include <stdexcept>

namespace independent {

Draws::Draws(std::uint64_t seed, std::map<std::string, std::string> fixed)
    : seed_(seed), fixed_(std::move(fixed)) {}

std::mt19937_64 Draws::stream(const std::string& name) const {
  std::vector<std::uint32_t> words = {static_cast<std::uint32_t>(seed_),
                                      static_cast<std::uint32_t>(seed_ >> 32)};
  for (const char letter : name) words.push_back(static_cast<unsigned char>(letter));
  std::seed_seq sequence(words.begin(), words.end());
  return std::mt19937_64(sequence);
}

const std::string* Draws::fixed(const std::string& name) {
  for (const auto& key : {name, name.substr(0, name.find('.'))}) {
    const auto found = fixed_.find(key);
    if (found == fixed_.end()) continue;
    used_.insert(key);
    return &found->second;
  }
  return nullptr;
}

double Draws::uniform(const std::string& name, double low, double high) {
  if (const auto* value = fixed(name)) return std::stod(*value);
  auto random = stream(name);
  return std::uniform_real_distribution<>(low, high)(random);
}

double Draws::log_uniform(const std::string& name, double low, double high) {
  if (const auto* value = fixed(name)) return std::stod(*value);
  auto random = stream(name);
  return std::exp(std::uniform_real_distribution<>(std::log(low), std::log(high))(random));
}

double Draws::truncated_normal(const std::string& name, double sd, double limit) {
  if (const auto* value = fixed(name)) return std::stod(*value);
  auto random = stream(name);
  std::normal_distribution<> normal;
  double value = normal(random);
  while (std::abs(value) > limit) value = normal(random);
  return sd * value;
}

int Draws::integer(const std::string& name, int low, int high) {
  if (const auto* value = fixed(name)) return std::stoi(*value);
  auto random = stream(name);
  return std::uniform_int_distribution<>(low, high)(random);
}

bool Draws::chance(const std::string& name, double probability) {
  if (const auto* value = fixed(name)) return *value != "0";
  auto random = stream(name);
  return std::uniform_real_distribution<>(0, 1)(random) < probability;
}

std::string Draws::choice(const std::string& name, const std::vector<Weighted>& values) {
  if (const auto* requested = fixed(name)) {
    std::string known;
    for (const auto& each : values) {
      if (each.value == *requested) return *requested;
      known += " " + each.value;
    }
    throw std::runtime_error(name + "=" + *requested + " is unknown; use one of:" + known);
  }
  std::vector<double> weights;
  for (const auto& each : values) weights.push_back(each.weight);
  auto random = stream(name);
  return values[std::discrete_distribution<std::size_t>(weights.begin(), weights.end())(random)].value;
}

void Draws::require_all_used() const {
  for (const auto& [name, value] : fixed_) {
    if (used_.contains(name)) continue;
    std::string draw = name;
    draw.append("=").append(value).append(" fixes no draw of this rig");
    throw std::runtime_error(draw);
  }
}

}  // namespace independent
