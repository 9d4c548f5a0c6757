// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace crisp::app {

/// Pipelines that are commands of their own: the files in configs/, as they were when crisp was built.
extern const std::string_view kBasinPipeline;
extern const std::string_view kBoundPipeline;
extern const std::string_view kDetectionPipeline;
extern const std::string_view kCalibratePipeline;
extern const std::string_view kDiagnosePipeline;
extern const std::string_view kConvertPipeline;
extern const std::string_view kEmulatePipeline;
extern const std::string_view kFiguresPipeline;
extern const std::string_view kMonteCarloPipeline;
extern const std::string_view kRecordPipeline;
extern const std::string_view kReportPipeline;

}  // namespace crisp::app
