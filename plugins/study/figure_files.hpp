// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "plugins/study/figures.hpp"

namespace crisp::study {

/// The figures as tables of plain columns for gnuplot and its like, by the names of their files: a header of
/// lines with #, numbers in SI but for angles in degrees, a blank line between the rows of a surface and two
/// between blocks. docs/figures draws them.
std::map<std::string, std::string> figure_files(const FigureSettings& settings, const Figures& figures);

}  // namespace crisp::study
