// SPDX-License-Identifier: BSD-3-Clause
// The tests' toy stages as a plugin, and some that a run of the program needs to be tested.
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <thread>

#include <crisp/atomic_file.hpp>
#include <crisp/plugin.hpp>

#include "pipeline/files/yaml.hpp"
#include "tests/pipeline/stage/toy_stages.hpp"

namespace crisp::toy {

using namespace crisp::files;

/// Writes the sum into a file, and adds a caveat if an option requests it.
class WriteStage final : public Stage {
 public:
  static void describe(StageDescription<WriteStage>& d) {
    d.name("toy.write").summary("writes the sum").takes<Sum>();
    d.option("file", &WriteStage::file_, "where to").writes().required();
    d.option("caveat", &WriteStage::caveat_, "whether to caveat it");
  }
  void process(const Inputs& in, Outputs&, Context& context) override {
    sum_ = in.get<Sum>().value;
    context.print("the sum is " + std::to_string(sum_));
    context.report({{"sum", sum_}});
    context.count("sums", 1);
    context.count("sums that were lost", 0);
    context.warn("it is only a toy");
    if (caveat_) context.mark_untrusted("the sum was with_caveats");
  }
  void finish(Outputs&, Context& context) override {
    write_file(file_, std::to_string(sum_) + "\n");
    context.wrote(file_);
  }

 private:
  std::filesystem::path file_;
  bool caveat_ = false;
  int sum_ = 0;
};

/// Writes a file that its options do not declare.
class WriteUndeclaredStage final : public Stage {
 public:
  static void describe(StageDescription<WriteUndeclaredStage>& d) {
    d.name("toy.write_undeclared").summary("writes what it does not declare").takes<Sum>();
    d.option("folder", &WriteUndeclaredStage::folder_, "where to").required();
    d.option("name", &WriteUndeclaredStage::name_, "which file");
  }
  void process(const Inputs&, Outputs&, Context&) override {}
  void finish(Outputs&, Context& context) override {
    write_file(folder_ / name_, "undeclared");
    context.wrote(folder_ / name_);
  }

 private:
  std::filesystem::path folder_;
  std::string name_;
};

/// Opens a file aside, reports it, and waits until it is interrupted.
class WaitStage final : public Stage {
 public:
  static void describe(StageDescription<WaitStage>& d) {
    d.name("toy.wait").summary("waits for a signal").gives<Number>();
    d.option("file", &WaitStage::file_, "what it is about to write").writes().required();
  }
  void process(const Inputs&, Outputs&, Context& context) override {
    AtomicFile out(file_);
    out.write("half");
    while (!context.interrupted()) {
      context.progress(0.5, "waiting");
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

 private:
  std::filesystem::path file_;
};

/// Is long at work on a file, without asking whether it is to stop.
class HangStage final : public Stage {
 public:
  static void describe(StageDescription<HangStage>& d) {
    d.name("toy.hang").summary("hears no signal").gives<Word>();
    d.option("file", &HangStage::file_, "what it is about to write").writes().required();
  }
  void process(const Inputs&, Outputs&, Context&) override {
    const AtomicFile out(file_);
    std::this_thread::sleep_for(std::chrono::minutes(2));
  }

 private:
  std::filesystem::path file_;
};

/// Throws when the run comes to its end.
class EndBadlyStage final : public Stage {
 public:
  static void describe(StageDescription<EndBadlyStage>& d) {
    d.name("toy.end_badly").summary("throws at the end").takes<Sum>();
  }
  void process(const Inputs&, Outputs&, Context&) override {}
  void finish(Outputs&, Context&) override { throw Error("the end is bad"); }
};

/// Stands, as long as it lives, where another file belongs: as what a full disk holds of files that are not
/// complete. Throws at the end, unless it stays for good.
class InTheWayStage final : public Stage {
 public:
  ~InTheWayStage() override {
    if (!stays_) std::filesystem::remove_all(folder_ / name_);
  }
  static void describe(StageDescription<InTheWayStage>& d) {
    d.name("toy.in_the_way").summary("is in the way").takes<Sum>();
    d.option("folder", &InTheWayStage::folder_, "where").required();
    d.option("name", &InTheWayStage::name_, "of which file");
    d.option("stays", &InTheWayStage::stays_, "whether it does when it is gone");
  }
  void process(const Inputs&, Outputs&, Context&) override {
    std::filesystem::create_directories(folder_ / name_ / "filled");
  }
  void finish(Outputs&, Context&) override {
    if (!stays_) throw Error("there is no room");
  }

 private:
  std::filesystem::path folder_;
  std::string name_;
  bool stays_ = false;
};

/// Waits until it is interrupted, and complains of what it could not do.
class ComplainStage final : public Stage {
 public:
  static void describe(StageDescription<ComplainStage>& d) {
    d.name("toy.complain").summary("complains of a signal").gives<Word>();
    d.option("file", &ComplainStage::file_, "written once it waits").required();
  }
  void process(const Inputs&, Outputs&, Context& context) override {
    write_file(file_, "");
    while (!context.interrupted()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    throw Error("half of the work is missing");
  }

 private:
  std::filesystem::path file_;
};

/// Does what the one word of its input requests: `done`, `caveat`, `fail`, `abort`, `hang` or `full`. Before,
/// it adds a line to the journal, which counts the calls for each input.
class PerformStage final : public Stage {
 public:
  static void describe(StageDescription<PerformStage>& d) {
    d.name("toy.perform").summary("does what its input requests").gives<Word>();
    d.option("file", &PerformStage::file_, "the input").required();
    d.option("result", &PerformStage::result_, "its output").writes().required();
    d.option("journal", &PerformStage::journal_, "to which it adds a line");
    d.option("text", &PerformStage::text_, "further text of its output");
  }
  void process(const Inputs&, Outputs&, Context& context) override {
    if (!journal_.empty()) std::ofstream(journal_, std::ios::app) << file_.filename().string() + "\n";
    const std::string what = read_text_file(file_, 100);
    context.reads(file_);
    AtomicFile result(result_);
    if (what == "fail") throw Error("the input requested a failure", "use another input");
    if (what == "full") throw Error("cannot write x: " + std::string(std::strerror(ENOSPC)));
    if (what == "abort") std::abort();
    while (what == "hang" || (what == "wait" && !context.interrupted()))
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    if (what == "caveat") context.mark_untrusted("the input requested a caveat");
    result.write(what + text_ + "\n");
    result.commit();
    context.wrote(result_);
  }

 private:
  std::filesystem::path file_;
  std::filesystem::path result_;
  std::string journal_;
  std::string text_;
};

void register_all(Registrar& registrar) {
  register_toys(registrar);
  registrar.stage<WriteStage>();
  registrar.stage<WaitStage>();
  registrar.stage<HangStage>();
  registrar.stage<WriteUndeclaredStage>();
  registrar.stage<EndBadlyStage>();
  registrar.stage<InTheWayStage>();
  registrar.stage<ComplainStage>();
  registrar.stage<PerformStage>();
}

}  // namespace crisp::toy

CRISP_PLUGIN("toy", "1.5", crisp::toy::register_all);
