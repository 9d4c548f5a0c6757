// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include <crisp/pipeline.hpp>
#include <crisp/registrar.hpp>

namespace crisp::stage {

/// Full description of a stage, for a terminal.
std::string stage_text(const StageType& type);

/// The same as a page of the reference, in Markdown.
std::string stage_markdown(const StageType& type);

/// The reference's first page: the stages by family, each a link to its page.
std::string index_markdown(const StageRegistry& stages);

/// A JSON schema of pipeline files with these stages, for editors that complete and check YAML.
nlohmann::ordered_json pipeline_schema(const StageRegistry& stages);

/// An option's value for programs: numbers in SI, lists as arrays, maps as objects, "auto".
nlohmann::json to_json(const OptionValue& value);

/// The effective options of a stage: all of them, with the values that it runs with, in SI.
nlohmann::ordered_json effective_options(const PipelineNode& node);

}  // namespace crisp::stage
