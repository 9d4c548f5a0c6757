// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/stage/wiring.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>

#include "pipeline/files/nearest.hpp"

namespace crisp::stage {
namespace {

class Connector {
 public:
  Connector(Pipeline& pipeline, const StageRegistry& registry, std::vector<Error>& errors)
      : nodes_(pipeline.nodes), registry_(registry), errors_(errors) {}

  void connect(std::size_t index, const StageSpec& spec) {
    PipelineNode& node = nodes_[index];
    if (!node.type) return;
    const auto named = spec.inputs ? resolve(index, *spec.inputs) : std::nullopt;
    if (spec.inputs && !named) return;  // the names themselves are wrong, as already reported
    for (const auto& input : node.type->inputs) {
      node.feeders.push_back(named ? those_that_give(input.kind, *named) : nearest_giver(input.kind, index));
      if (node.feeders.back().empty() && input.required && all_known_above(index)) {
        errors_.push_back(nothing_feeds(node, input, index));
      }
    }
    if (named) check_each_is_of_use(node, *spec.inputs, *named);
  }

 private:
  /// The nodes that `inputs` names; nothing if one of the names is wrong.
  std::optional<std::vector<std::size_t>> resolve(std::size_t index,
                                                  const std::vector<TagReference>& inputs) {
    std::vector<std::size_t> found;
    for (const auto& reference : inputs) {
      const auto above = nodes_.begin() + static_cast<std::ptrdiff_t>(index);
      const auto node =
          std::find_if(nodes_.begin(), above, [&](const auto& n) { return n.tag == reference.tag; });
      if (node == above) {
        errors_.push_back(no_such_tag(index, reference));
      } else {
        found.push_back(static_cast<std::size_t>(node - nodes_.begin()));
      }
    }
    if (found.size() != inputs.size()) return std::nullopt;
    return found;
  }

  std::vector<std::size_t> those_that_give(const Kind& kind,
                                           const std::vector<std::size_t>& candidates) const {
    std::vector<std::size_t> feeders;
    for (const auto candidate : candidates) {
      if (nodes_[candidate].type && nodes_[candidate].type->gives(kind)) feeders.push_back(candidate);
    }
    return feeders;
  }

  std::vector<std::size_t> nearest_giver(const Kind& kind, std::size_t index) const {
    while (index-- > 0) {
      if (nodes_[index].type && nodes_[index].type->gives(kind)) return {index};
    }
    return {};
  }

  /// Whether a missing feeder is a mistake of its own, and not the shadow of a misspelt stage.
  bool all_known_above(std::size_t index) const {
    return std::all_of(nodes_.begin(), nodes_.begin() + static_cast<std::ptrdiff_t>(index),
                       [](const auto& node) { return node.type != nullptr; });
  }

  void check_each_is_of_use(const PipelineNode& node, const std::vector<TagReference>& references,
                            const std::vector<std::size_t>& named) {
    for (std::size_t i = 0; i < named.size(); ++i) {
      const StageType* giver = nodes_[named[i]].type;
      if (!giver) continue;
      const auto fits = [&](const StageInput& input) { return giver->gives(input.kind); };
      if (std::any_of(node.type->inputs.begin(), node.type->inputs.end(), fits)) continue;
      errors_.emplace_back(
          fmt::format("{}: '{}' gives no item that {} takes", node.tag, references[i].tag, node.type->name),
          fmt::format("it gives {}, and {} takes {}", kinds(giver->outputs), node.type->name,
                      kinds(taken(*node.type))),
          references[i].place);
    }
  }

  Error no_such_tag(std::size_t index, const TagReference& reference) const {
    std::vector<std::string> above;
    for (std::size_t i = 0; i < index; ++i) above.push_back(nodes_[i].tag);
    const auto below = std::any_of(nodes_.begin() + static_cast<std::ptrdiff_t>(index), nodes_.end(),
                                   [&](const auto& node) { return node.tag == reference.tag; });
    if (below) {
      return Error(fmt::format("{}: its input '{}' is not above it", nodes_[index].tag, reference.tag),
                   "a stage is fed only by stages above it", reference.place);
    }
    return Error(fmt::format("{}: there is no stage with the tag '{}'", nodes_[index].tag, reference.tag),
                 files::did_you_mean(reference.tag, above, {}), reference.place);
  }

  Error nothing_feeds(const PipelineNode& node, const StageInput& input, std::size_t index) const {
    const std::string kind(input.kind.name());
    std::string advice;
    if (!nearest_giver(input.kind, index).empty()) {
      advice = fmt::format("add '{}' to its inputs", nodes_[nearest_giver(input.kind, index).front()].tag);
    } else if (const auto givers = registry_.givers(input.kind); !givers.empty()) {
      advice = fmt::format("put one of these above it: {}", fmt::join(givers, ", "));
    } else {
      advice = "no known stage gives one";
    }
    return Error(fmt::format("{}: nothing above it gives the {} that it takes", node.tag, kind), advice,
                 node.place);
  }

  static std::vector<Kind> taken(const StageType& type) {
    std::vector<Kind> list;
    for (const auto& input : type.inputs) list.push_back(input.kind);
    return list;
  }

  static std::string kinds(const std::vector<Kind>& list) {
    std::vector<std::string_view> names;
    for (const auto& kind : list) names.push_back(kind.name());
    return names.empty() ? "nothing" : fmt::format("{}", fmt::join(names, ", "));
  }

  std::vector<PipelineNode>& nodes_;
  const StageRegistry& registry_;
  std::vector<Error>& errors_;
};

class LowStages {
 public:
  explicit LowStages(const std::vector<PipelineNode>& nodes) : nodes_(nodes) {}

  /// The topmost stage that this one could feed if it stood above it, where all that it gives could be taken
  /// there and is taken nowhere; nothing otherwise.
  std::optional<std::size_t> belongs_above(std::size_t index) const {
    const auto& outputs = nodes_[index].type->outputs;
    if (outputs.empty() || feeds_any(index)) return std::nullopt;
    const std::vector<bool> needed = ancestors(index);
    std::optional<std::size_t> topmost;
    for (const Kind& kind : outputs) {
      std::size_t taker = 0;
      while (taker < index && (needed[taker] || !takes(taker, kind))) ++taker;
      if (taker == index) return std::nullopt;
      topmost = std::min(topmost.value_or(taker), taker);
    }
    return topmost;
  }

 private:
  bool feeds_any(std::size_t index) const {
    return std::any_of(nodes_.begin(), nodes_.end(), [&](const PipelineNode& node) {
      return std::any_of(node.feeders.begin(), node.feeders.end(), [&](const auto& feeders) {
        return std::find(feeders.begin(), feeders.end(), index) != feeders.end();
      });
    });
  }

  bool takes(std::size_t index, const Kind& kind) const {
    const auto& inputs = nodes_[index].type->inputs;
    return std::any_of(inputs.begin(), inputs.end(), [&](const auto& input) { return input.kind == kind; });
  }

  /// Whether each of those above is what this one cannot do without.
  std::vector<bool> ancestors(std::size_t index) const {
    std::vector<bool> found(index + 1, false);
    found[index] = true;
    for (std::size_t i = index + 1; i-- > 0;) {
      if (!found[i]) continue;
      for (const auto& feeders : nodes_[i].feeders) {
        for (const auto feeder : feeders) found[feeder] = true;
      }
    }
    return found;
  }

  const std::vector<PipelineNode>& nodes_;
};

}  // namespace

std::vector<PipelineWarning> put_too_low(const Pipeline& pipeline) {
  std::vector<PipelineWarning> warnings;
  const LowStages low(pipeline.nodes);
  for (std::size_t i = 0; i < pipeline.nodes.size(); ++i) {
    const auto above = low.belongs_above(i);
    if (!above) continue;
    const std::string& tag = pipeline.nodes[i].tag;
    warnings.push_back({fmt::format("{}: no stage below takes the items of {}; move it above {}, which does",
                                    tag, tag, pipeline.nodes[*above].tag),
                        pipeline.nodes[i].place});
  }
  return warnings;
}

void connect(Pipeline& pipeline, const std::vector<StageSpec>& specs, const StageRegistry& registry,
             std::vector<Error>& errors) {
  Connector connector(pipeline, registry, errors);
  for (std::size_t i = 0; i < specs.size(); ++i) connector.connect(i, specs[i]);
}

}  // namespace crisp::stage
