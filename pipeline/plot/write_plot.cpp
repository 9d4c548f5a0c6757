// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/plot/write_plot.hpp"

#include <crisp/atomic_file.hpp>

namespace crisp::plot {

void write_plots(const std::filesystem::path& file, const std::vector<Plot>& plots, Context& context) {
  write_file(file, as_svg(plots));
  context.wrote(file);
}

}  // namespace crisp::plot
