// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <crisp/registrar.hpp>

#include "tests/pipeline/stage/toy_stages.hpp"

namespace crisp {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

template <class Wrong>
std::string refusal() {
  Registrar registrar;
  try {
    registrar.stage<Wrong>();
  } catch (const Error& error) {
    return error.what();
  }
  return "not refused";
}

struct Idle : Stage {
  void process(const Inputs&, Outputs&, Context&) override {}
};

struct Nameless : Idle {
  static void describe(StageDescription<Nameless>& d) { d.name("Nameless").summary("-"); }
};
struct BadDefault : Idle {
  double width = -1;
  static void describe(StageDescription<BadDefault>& d) {
    d.name("toy.bad").summary("-").option("width", &BadDefault::width, "width").unit("m").range(0, 1);
  }
};
struct NamelessChoice : Idle {
  enum class Way { here, there } way = Way::here;
  static void describe(StageDescription<NamelessChoice>& d) {
    d.name("toy.bad").summary("-").option("way", &NamelessChoice::way, "which way");
  }
};
struct HoldsOnly : Idle {
  static void describe(StageDescription<HoldsOnly>& d) { d.name("toy.bad").summary("-").holds<toy::Sum>(); }
};
struct TakesTwice : Idle {
  static void describe(StageDescription<TakesTwice>& d) {
    d.name("toy.bad").summary("-").takes<toy::Sum>().holds<toy::Sum>();
  }
};

struct GroupWithoutHelp : Idle {
  int rate = 0;
  static void describe(StageDescription<GroupWithoutHelp>& d) {
    d.name("toy.bad").summary("-").option("motion.rate", &GroupWithoutHelp::rate, "rate");
  }
};
struct GroupAndOption : Idle {
  int value = 0;
  static void describe(StageDescription<GroupAndOption>& d) {
    d.name("toy.bad").summary("-").group("motion", "how it moves");
    d.option("motion", &GroupAndOption::value, "motion");
    d.option("motion.rate", &GroupAndOption::value, "rate");
  }
};

TEST(StageRegistry, RefusesDescriptionsThatCannotBeRight) {
  EXPECT_THAT(refusal<Nameless>(), HasSubstr("'Nameless' is not a stage's name"));
  EXPECT_THAT(refusal<BadDefault>(),
              HasSubstr("its default -1m is out of range, expected is a number in m, 0 to 1"));
  EXPECT_THAT(refusal<NamelessChoice>(), HasSubstr("an enumeration needs choices()"));
  EXPECT_THAT(refusal<HoldsOnly>(), HasSubstr("takes none that makes it run"));
  EXPECT_THAT(refusal<TakesTwice>(), HasSubstr("takes Sum twice"));
  EXPECT_THAT(refusal<GroupWithoutHelp>(), HasSubstr("'motion.rate' wrongly: its group has no help"));
  EXPECT_THAT(refusal<GroupAndOption>(), HasSubstr("'motion' wrongly: a group has the same name"));
}

TEST(StageRegistry, RefusesASecondStageOfTheSameNameWithBothOrigins) {
  Registrar registrar;
  registrar.stage<toy::CountStage>();
  registrar.set_origin("other.so");
  EXPECT_THROW(
      {
        try {
          registrar.stage<toy::CountStage>();
        } catch (const Error& error) {
          EXPECT_THAT(error.what(), HasSubstr("two stages toy.count: one built in, one other.so"));
          throw;
        }
      },
      Error);
}

TEST(StageRegistry, KnowsWhichStagesGiveAKind) {
  Registrar registrar;
  toy::register_toys(registrar);
  EXPECT_THAT(registrar.stages().givers(Kind::of<toy::Sum>()), ElementsAre("toy.sum"));
}

TEST(Registrar, HandsOutTheRegistriesThatWereAttached) {
  struct Measures {
    std::vector<std::string> names;
  } measures;
  Registrar registrar;
  EXPECT_THROW(registrar.get<Measures>(), Error);
  registrar.attach(measures);
  registrar.get<Measures>().names.emplace_back("rqe");
  EXPECT_THAT(measures.names, ElementsAre("rqe"));
}

}  // namespace
}  // namespace crisp
