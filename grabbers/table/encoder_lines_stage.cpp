// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/table/encoder_lines_stage.hpp"

#include <fmt/format.h>

#include <limits>

#include <crisp/error.hpp>

namespace crisp::table {

void EncoderLinesStage::describe(StageDescription<EncoderLinesStage>& d) {
  d.name("grabber.encoder_lines").summary("reads encoder readings from a file of the encoder's lines");
  d.details(
      "The file holds what the encoder sent over a serial line, or what a program logged of it: lines of the format that the rig gives by `plate: {line: …}`, or else sentences of $PPLT. It may be compressed by gzip or zstd. The stage stands behind the grabber of the scans, and gives these with the readings in the order of their receipt.\n\n"
      "A clock stage aligns the encoder's clock by times of receipt. A logger that adds them writes each before its line, apart by a blank, comma or semicolon: `1700000000.0123 ENC,1523342,-17`. In a file without them a line's own time stands for its receipt; scans and lines must then have times of one clock.\n\n"
      "Lines of other kinds are counted. Damaged lines are counted, too, and the first is named with its line.");
  d.takes<Scan>().gives<Scan>().gives<PlateReading>();
  d.option("file", &EncoderLinesStage::path_, "the lines").required();
  d.option("stamp_unit", &EncoderLinesStage::stamp_unit_,
           "unit of the time of receipt before each line; auto: there is no such time")
      .choices({{"s", TimeUnit::s}, {"ms", TimeUnit::ms}, {"us", TimeUnit::us}, {"ns", TimeUnit::ns}});
}

void EncoderLinesStage::check(const RunSettings& run) const {
  const auto& line = run.rig.plate.line;
  if (stamp_unit_ || !line || line->time_column) return;
  throw Error(
      "the encoder's lines have no time",
      "give the column of their own time in the rig (time_column), or stamp_unit: s for lines with times of receipt");
}

EncoderLinesStage::File::File(const std::filesystem::path& file, const Rig& rig,
                              std::optional<TimeUnit> stamp_unit)
    : stream(file), buffer(stream), in(&buffer), lines(in, file.string(), rig.plate.line, stamp_unit) {
  in.exceptions(std::ios::badbit);
  next = lines.next();
}

void EncoderLinesStage::give_until(std::int64_t receipt_ns, Outputs& out, Context& context) {
  if (!file_) {
    context.reads(path_);
    file_.emplace(path_, context.rig(), stamp_unit_);
  }
  while (file_->next && file_->next->receipt_ns <= receipt_ns) {
    out.give(*file_->next);
    file_->next = file_->lines.next();
  }
}

void EncoderLinesStage::process(const Inputs& in, Outputs& out, Context& context) {
  auto scan = in.share<Scan>();
  give_until(scan->receipt_ns, out, context);
  out.give(std::move(scan));
}

void EncoderLinesStage::finish(Outputs& out, Context& context) {
  give_until(std::numeric_limits<std::int64_t>::max(), out, context);
  report(context);
}

void EncoderLinesStage::report(Context& context) const {
  const EncoderLines& lines = file_->lines;
  for (const auto& [what, n] : lines.losses()) context.count(what, n);
  const auto& fault = lines.first_fault();
  if (lines.readings() == 0) {
    if (fault)
      throw Error("no line can be read: " + fault->message(), "check the format of the rig's plate",
                  fault->place());
    throw Error(path_.string() + " holds no line of the encoder",
                "give the format of its lines in the rig: plate: {line: …}");
  }
  if (fault) context.warn(to_string(fault->place()) + ": here is the first of the " + fault->message());
  context.report({{"readings", lines.readings()}});
  context.print(fmt::format("{} readings of {}", lines.readings(), context.rig().plate.name));
}

}  // namespace crisp::table
