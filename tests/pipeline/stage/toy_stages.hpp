// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Small stages that the tests build pipelines of: they pass numbers and words along and write down, in a log
// that all of them share, what they were called with and when.

#include <string>
#include <vector>

#include <crisp/context.hpp>
#include <crisp/registrar.hpp>
#include <crisp/stage.hpp>

namespace crisp::toy {

struct Number {
  int value = 0;
};
struct Word {
  std::string text;
};
struct Sum {
  int value = 0;
};

inline std::vector<std::string>& log() {
  static std::vector<std::string> entries;
  return entries;
}

}  // namespace crisp::toy

template <>
struct crisp::KindName<crisp::toy::Number> {
  static constexpr std::string_view value = "Number";
};
template <>
struct crisp::KindName<crisp::toy::Word> {
  static constexpr std::string_view value = "Word";
};
template <>
struct crisp::KindName<crisp::toy::Sum> {
  static constexpr std::string_view value = "Sum";
};

namespace crisp::toy {

/// Gives 1, 2, … until the run is stopped.
class EndlessStage final : public Stage {
 public:
  static void describe(StageDescription<EndlessStage>& d) {
    d.name("toy.endless").summary("counts without end").endless().gives<Number>();
  }
  void process(const Inputs&, Outputs& out, Context& context) override {
    for (int i = 1; !context.interrupted(); ++i) out.give(Number{i});
  }
};

/// Reports its status.
class StatusStage final : public Stage {
 public:
  static void describe(StageDescription<StatusStage>& d) {
    d.name("toy.status").summary("reports its status").gives<Word>();
  }
  void process(const Inputs&, Outputs&, Context& context) override {
    if (context.is_watched())
      context.set_status({.line = "is well", .gauges = {{.name = "health", .value = 1}}});
  }
};

/// Gives first, first + 1, … in process.
class CountStage final : public Stage {
 public:
  static void describe(StageDescription<CountStage>& d) {
    d.name("toy.count").summary("counts").gives<Number>();
    d.option("n", &CountStage::n_, "how many numbers").range(0, 1000);
    d.option("first", &CountStage::first_, "the first of them");
  }
  void process(const Inputs&, Outputs& out, Context&) override {
    for (int i = 0; i < n_; ++i) out.give(Number{first_ + i});
  }
  void finish(Outputs&, Context&) override { log().emplace_back("count finishes"); }

 private:
  int n_ = 3;
  int first_ = 1;
};

/// Gives a word at once, or only when it finishes, or never.
class PrintStage final : public Stage {
 public:
  static void describe(StageDescription<PrintStage>& d) {
    d.name("toy.words").summary("gives words").gives<Word>();
    d.option("words", &PrintStage::words_, "words to give");
  }
  void process(const Inputs&, Outputs& out, Context&) override {
    for (const auto& word : words_) out.give(Word{word});
  }

 private:
  std::vector<std::string> words_ = {"hello"};
};

/// Adds the numbers up; gives the sum in finish.
class SumStage final : public Stage {
 public:
  static void describe(StageDescription<SumStage>& d) {
    d.name("toy.sum").summary("adds numbers up").takes<Number>().gives<Sum>();
    d.option("silent", &SumStage::silent_, "gives no sum");
  }
  void process(const Inputs& in, Outputs&, Context&) override { sum_ += in.get<Number>().value; }
  void finish(Outputs& out, Context&) override {
    if (!silent_) out.give(Sum{sum_});
  }

 private:
  bool silent_ = false;
  int sum_ = 0;
};

/// Takes numbers, holds the sum, and perhaps a word; logs each call; gives the number's share of the sum in
/// %.
class ShareStage final : public Stage {
 public:
  static void describe(StageDescription<ShareStage>& d) {
    d.name("toy.share").summary("divides").takes<Number>().holds<Sum>().holds<Word>(Need::optional);
    d.gives<Number>();
  }
  void process(const Inputs& in, Outputs& out, Context&) override {
    const auto* word = in.find<Word>();
    log().push_back(std::to_string(in.get<Number>().value) + "/" + std::to_string(in.get<Sum>().value) +
                    (word ? " " + word->text : ""));
    out.give(Number{100 * in.get<Number>().value / in.get<Sum>().value});
  }
};

/// Takes numbers and words; logs them in their order of arrival.
class LogStage final : public Stage {
 public:
  static void describe(StageDescription<LogStage>& d) {
    d.name("toy.log").summary("writes down").takes<Number>(Need::optional).takes<Word>(Need::optional);
  }
  void process(const Inputs& in, Outputs&, Context& context) override {
    if (const auto* number = in.find<Number>()) log().push_back("number " + std::to_string(number->value));
    if (const auto* word = in.find<Word>()) log().push_back("word " + word->text);
    context.count("entries");
  }
  void finish(Outputs&, Context&) override { log().emplace_back("log finishes"); }
};

/// Throws the exception `how` when it sees its third number.
class ThrowStage final : public Stage {
 public:
  enum class How { error, standard, memory, undeclared, integer };
  static void describe(StageDescription<ThrowStage>& d) {
    d.name("toy.throw").summary("throws").takes<Number>().gives<Number>();
    d.option("how", &ThrowStage::how_, "what it throws")
        .choices({{"error", How::error},
                  {"standard", How::standard},
                  {"memory", How::memory},
                  {"undeclared", How::undeclared},
                  {"integer", How::integer}});
  }
  void process(const Inputs& in, Outputs& out, Context&) override {
    if (in.get<Number>().value < 3) return out.give(*in.find<Number>());
    switch (how_) {
      case How::error:
        throw Error("it saw a three", "avoid threes");
      case How::standard:
        throw std::out_of_range("three");
      case How::memory:
        throw std::bad_alloc();
      case How::undeclared:
        return out.give(Word{"three"});
      case How::integer:
        throw 3;
    }
  }

 private:
  How how_ = How::error;
};

/// Passes numbers on with a caveat, or resolves the caveats of the item that it replaces.
class CaveatStage final : public Stage {
 public:
  static void describe(StageDescription<CaveatStage>& d) {
    d.name("toy.caveat").summary("caveats").takes<Number>().gives<Number>();
    d.option("lift", &CaveatStage::lift_, "whether it settles the caveats of others");
  }
  void process(const Inputs& in, Outputs& out, Context&) override { out.give(*in.find<Number>()); }
  void finish(Outputs&, Context& context) override {
    if (lift_) return context.resolve_caveats(KindName<Number>::value, "they add up");
    context.mark_untrusted("are these numbers?");
  }

 private:
  bool lift_ = false;
};

/// Reports what the stages above it with_caveats.
class HearStage final : public Stage {
 public:
  static void describe(StageDescription<HearStage>& d) {
    d.name("toy.hear").summary("hears caveats").takes<Sum>();
  }
  void process(const Inputs&, Outputs&, Context&) override {}
  void finish(Outputs&, Context& context) override { context.report({{"caveats", context.caveats_above()}}); }
};

inline void register_toys(Registrar& registrar) {
  registrar.stage<CountStage>();
  registrar.stage<EndlessStage>();
  registrar.stage<StatusStage>();
  registrar.stage<PrintStage>();
  registrar.stage<SumStage>();
  registrar.stage<ShareStage>();
  registrar.stage<LogStage>();
  registrar.stage<ThrowStage>();
  registrar.stage<CaveatStage>();
  registrar.stage<HearStage>();
}

}  // namespace crisp::toy
