// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/study/basin_text.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "pipeline/data/counted.hpp"
#include "plugins/study/parameter_kind.hpp"

namespace crisp::study {
namespace {

const char* word(Ending ending) {
  switch (ending) {
    case Ending::kSame:
      return "same";
    case Ending::kWithCaveats:
      return "caveats";
    case Ending::kSilent:
      return "silent";
  }
  return "";
}

/// A calibration's caveats, in one line and without quotation marks.
std::string in_one(const std::vector<std::string>& caveats) {
  std::string text = fmt::format("{}", fmt::join(caveats, "; "));
  std::ranges::replace(text, '"', '\'');
  std::ranges::replace(text, '\n', ' ');
  return text;
}

std::string reported(const BasinRecording& recording, std::size_t k) {
  const BasinStart& start = recording.starts[k];
  std::string text = fmt::format("recording {} start {}: ", recording.seed, k);
  if (start.farthest.empty()) return text + in_one(start.caveats);
  const ParameterKind& kind = kind_of(start.farthest);
  text += fmt::format("{} off by {:.4g} {}, {:.3g} standard errors", start.farthest, start.error / kind.in_si,
                      kind.unit, start.off);
  return text + (start.caveats.empty() ? "; without caveats" : "; caveats: " + in_one(start.caveats));
}

}  // namespace

BasinTally tally_of(const std::vector<BasinRecording>& recordings) {
  BasinTally tally;
  for (const BasinRecording& recording : recordings) {
    tally.failed += recording.failure.empty() ? 0 : 1;
    for (const BasinStart& start : recording.starts) {
      ++tally.starts;
      tally.same += start.ending == Ending::kSame ? 1 : 0;
      tally.with_caveats += start.ending == Ending::kWithCaveats ? 1 : 0;
      tally.silent += start.ending == Ending::kSilent ? 1 : 0;
      tally.same_with_caveats += start.ending == Ending::kSame && !start.caveats.empty() ? 1 : 0;
    }
  }
  return tally;
}

std::string basin_text(const std::vector<BasinRecording>& recordings) {
  const BasinTally tally = tally_of(recordings);
  const double percent = 100 / std::max(1.0, static_cast<double>(tally.starts));
  const auto line = [&](const char* what, std::size_t n) {
    return fmt::format("{:<46}{:>7}  {:>6.2f} %\n", what, n, percent * static_cast<double>(n));
  };
  std::string text = fmt::format("{} on {}\n", data::counted(tally.starts, "start"),
                                 data::counted(recordings.size() - tally.failed, "recording"));
  text += line("ended in the optimum at the truth", tally.same);
  text += line("  of these with caveats", tally.same_with_caveats);
  text += line("elsewhere, with caveats", tally.with_caveats);
  text += line("elsewhere, without caveats", tally.silent);
  for (const BasinRecording& recording : recordings) {
    if (!recording.failure.empty()) {
      text += fmt::format("recording {}: even from the truth: {}\n", recording.seed, recording.failure);
    }
    for (std::size_t k = 0; k < recording.starts.size(); ++k) {
      if (recording.starts[k].ending != Ending::kSame) text += reported(recording, k) + "\n";
    }
  }
  text.pop_back();
  return text;
}

std::string basin_csv(const std::vector<BasinRecording>& recordings) {
  std::string text = "recording,start,parameter,unit,value,ending,off,farthest,error,caveats\n";
  for (const BasinRecording& recording : recordings) {
    for (std::size_t k = 0; k < recording.starts.size(); ++k) {
      const BasinStart& start = recording.starts[k];
      for (std::size_t p = 0; p < recording.parameters.size(); ++p) {
        const std::string& name = recording.parameters[p];
        text += fmt::format("{},{},{},{},{:.6g},{},{:.3g},{},{:.6g},\"{}\"\n", recording.seed, k, name,
                            kind_of(name).si, start.start[p], word(start.ending), start.off, start.farthest,
                            start.error, in_one(start.caveats));
      }
    }
  }
  return text;
}

}  // namespace crisp::study
