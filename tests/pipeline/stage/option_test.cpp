// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <crisp/option_set.hpp>

namespace crisp {
namespace {

using testing::ElementsAre;
using testing::Optional;

enum class Search { flann, grid };

struct Inner {
  double sigma = 0.05;
};
struct Thing {
  bool flag = false;
  std::uint8_t small = 7;
  double length = 1.5;
  float ratio = 0.5F;
  std::string word = "a";
  std::filesystem::path file = "x/y";
  Search search = Search::grid;
  std::vector<double> widths = {0.5, 0.01};
  std::vector<std::string> names;
  std::optional<double> window;
  OptionGroups groups;
  Inner inner;
  Inner& get_inner() { return inner; }
};

struct Fixture : testing::Test {
  OptionSet<Thing> options;
  Thing thing;

  const Option& last() const { return options.all().back(); }
  OptionValue value() const { return last().get(&thing); }
  std::string text() const { return to_text(last(), value()); }
  void set(const OptionValue& to) { last().set(&thing, to); }
};

TEST_F(Fixture, HoldsAMapOfMaps) {
  options.add("groups", &Thing::groups, "-");
  EXPECT_EQ(text(), "{}");
  set(OptionGroups{{.name = "a.b", .entries = {{"c", "1deg", {}}, {"d", "2", {}}}}, {.name = "e"}});
  EXPECT_EQ(thing.groups.at(0).entries.at(1).value, "2");
  EXPECT_EQ(text(), "{a.b: {c: 1deg, d: 2}, e: {}}");
  EXPECT_FALSE(complaint(last(), value()));
  EXPECT_TRUE(complaint(last(), OptionScalar(1.0)));
  EXPECT_TRUE(complaint(last(), std::monostate{}));
}

TEST_F(Fixture, RefusesAPathOfAnotherFormat) {
  options.add("file", &Thing::file, "-").ending(".pcd");
  EXPECT_FALSE(complaint(last(), OptionScalar(std::string("a.b/cloud.pcd"))));
  EXPECT_FALSE(complaint(last(), OptionScalar(std::string("CLOUD.PCD"))));
  for (const std::string wrong : {"cloud.ply", "cloud", "", "cloud.pcd.gz", "a.pcd/cloud"}) {
    EXPECT_EQ(complaint(last(), OptionScalar(wrong)), "'" + wrong + "' is no name of a .pcd file");
  }
  EXPECT_EQ(expectation(last()), "a path that ends in .pcd");
}

TEST_F(Fixture, RefusesAMapOfMapsWhereAListIsRequested) {
  options.add("names", &Thing::names, "-");
  EXPECT_TRUE(complaint(last(), OptionGroups{}));
}

TEST_F(Fixture, ReadsAndSetsEveryTypeOfMember) {
  options.add("flag", &Thing::flag, "-");
  set(OptionScalar(true));
  EXPECT_TRUE(thing.flag);
  EXPECT_EQ(text(), "true");

  options.add("small", &Thing::small, "-");
  set(OptionScalar(std::int64_t{255}));
  EXPECT_EQ(thing.small, 255);

  options.add("length", &Thing::length, "-").unit("m");
  EXPECT_EQ(text(), "1.5m");
  set(OptionScalar(2.0));
  EXPECT_EQ(thing.length, 2.0);

  options.add("ratio", &Thing::ratio, "-").unit("1");
  EXPECT_EQ(text(), "0.5");

  options.add("word", &Thing::word, "-").choices({"a", "b"});
  set(OptionScalar(std::string("b")));
  EXPECT_EQ(thing.word, "b");

  options.add("file", &Thing::file, "-");
  EXPECT_EQ(text(), "x/y");

  options.add("search", &Thing::search, "-").choices({{"flann", Search::flann}, {"grid", Search::grid}});
  EXPECT_EQ(text(), "grid");
  set(OptionScalar(std::string("flann")));
  EXPECT_EQ(thing.search, Search::flann);

  options.add("widths", &Thing::widths, "-").unit("m");
  EXPECT_EQ(text(), "[0.5m, 0.01m]");
  set(std::vector<OptionScalar>{1.0, 2.0, 3.0});
  EXPECT_THAT(thing.widths, ElementsAre(1, 2, 3));

  options.add("names", &Thing::names, "-");
  EXPECT_EQ(text(), "[]");

  options.add("window", &Thing::window, "-").unit("s");
  EXPECT_EQ(text(), "auto");
  set(OptionScalar(9.0));
  EXPECT_EQ(thing.window, 9.0);
  set(std::monostate{});
  EXPECT_FALSE(thing.window);
}

TEST_F(Fixture, ReachesMembersThroughChainsAndGetters) {
  options.add("a", &Thing::inner, &Inner::sigma, "-");
  set(OptionScalar(0.25));
  EXPECT_EQ(thing.inner.sigma, 0.25);
  options.add("b", &Thing::get_inner, &Inner::sigma, "-");
  set(OptionScalar(0.5));
  EXPECT_EQ(thing.inner.sigma, 0.5);
}

TEST_F(Fixture, ComplainsOfValuesThatDoNotFit) {
  options.add("small", &Thing::small, "-");
  EXPECT_THAT(complaint(last(), OptionScalar(std::int64_t{256})),
              Optional(std::string("256 is out of range")));
  EXPECT_THAT(complaint(last(), OptionScalar(1.0)), Optional(std::string("is of the wrong type")));
  EXPECT_THAT(complaint(last(), std::monostate{}), Optional(std::string("cannot be 'auto'")));

  options.add("widths", &Thing::widths, "-").unit("m").range(0.1, 1).count(1, 2);
  EXPECT_EQ(complaint(last(), std::vector<OptionScalar>{0.1, 1.0}), std::nullopt);
  EXPECT_THAT(complaint(last(), std::vector<OptionScalar>{0.1, 1.01}),
              Optional(std::string("1.01m is out of range")));
  EXPECT_THAT(complaint(last(), std::vector<OptionScalar>{}), Optional(std::string("has 0 elements")));
  EXPECT_THAT(complaint(last(), std::vector<OptionScalar>{std::nan("")}),
              Optional(std::string("is not a finite number")));
  EXPECT_EQ(expectation(last()), "a list, each a number in m, 0.1 to 1, 1 or more of them, 2 at most");
  options.add("both", &Thing::widths, "-").unit("m").count(2, 2);
  EXPECT_EQ(expectation(last()), "a list, each a number in m, 2 of them");
}

}  // namespace
}  // namespace crisp
