// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/study/figures_stage.hpp"

#include <fmt/format.h>

#include <crisp/atomic_file.hpp>

#include "plugins/study/figure_files.hpp"
#include "plugins/study/rqe.hpp"

namespace crisp::study {

void FiguresStage::describe(StageDescription<FiguresStage>& d) {
  d.name("study.figures").summary("computes the data of the paper's figures 4 to 7");
  d.details(
      "From a simulated recording of one laser's two beams in the plate's plane: the cloud of one beam with and without its lag (figure 4), RQE over tau and alpha (figure 5), at several kernel widths (figure 6), and over eta (figure 7). Plain columns with a header; docs/figures holds scripts that draw them.");
  d.option("folder", &FiguresStage::folder_, "folder of the output files")
      .writes_into({"fig*.dat"})
      .required();
  d.option("eta", &FiguresStage::settings_, &FigureSettings::eta, "true lag").unit("s").range(-0.1, 0.1);
  d.option("sigma", &FiguresStage::settings_, &FigureSettings::sigma, "kernel width in figure 5")
      .unit("m")
      .range(1e-3, 10);
  d.option("widths", &FiguresStage::settings_, &FigureSettings::widths, "kernel widths in figure 6")
      .unit("m")
      .range(1e-3, 10)
      .count(1, 20);
  d.option("lag_widths", &FiguresStage::settings_, &FigureSettings::lag_widths, "kernel widths in figure 7")
      .unit("m")
      .range(1e-3, 10)
      .count(1, 20);
}

void FiguresStage::process(const Inputs&, Outputs&, Context& context) {
  settings_.seed = context.seed();
  const auto measure = rqe_maker(context.run())();
  figures_ = make_figures(settings_, *measure, [&] { return context.interrupted(); });
}

void FiguresStage::finish(Outputs&, Context& context) {
  for (const auto& [name, text] : figure_files(settings_, figures_)) {
    write_file(folder_ / name, text);
    context.wrote(folder_ / name);
  }
  context.report({{"eta", settings_.eta}, {"eta_found", figures_.after.eta}});
  context.print(fmt::format("figure 4: a lag of {:.2f} ms, found as {:.2f} ms", settings_.eta * 1e3,
                            figures_.after.eta * 1e3));
}

}  // namespace crisp::study
