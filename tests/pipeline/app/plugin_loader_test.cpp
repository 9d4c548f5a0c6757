// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>

#include <crisp/atomic_file.hpp>
#include <crisp/plugin.hpp>
#include <crisp/plugin_loader.hpp>

#include "tests/pipeline/stage/toy_stages.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(PluginLoader, RegistersTheStagesOfAPluginWithTheirOrigin) {
  Registrar registrar;
  PluginLoader loader(registrar);
  loader.load(TOY_PLUGIN);
  ASSERT_EQ(loader.tried().size(), 1u);
  EXPECT_EQ(loader.tried()[0].refusal, "");
  EXPECT_EQ(loader.tried()[0].name, "toy");
  EXPECT_EQ(loader.tried()[0].version, "1.5");
  EXPECT_THAT(loader.tried()[0].brings, Contains("stage toy.write"));
  ASSERT_NE(registrar.stages().find("toy.write"), nullptr);
  EXPECT_THAT(registrar.stages().find("toy.write")->origin, HasSubstr("toy_plugin.so"));
  EXPECT_EQ(registrar.origin(), "built in");
  EXPECT_NE(registrar.stages().find("toy.write")->make(), nullptr);
}

TEST(PluginLoader, RefusesAPluginOfAnotherCompilerBeforeAnyOfItsCodeRuns) {
  Registrar registrar;
  PluginLoader loader(registrar);
  loader.load(FOREIGN_PLUGIN);
  EXPECT_EQ(
      loader.tried().at(0).refusal,
      "it was built for 'gcc-4 cxx11_abi=0 eigen_align=16 crisp=0.0.1', and this program is '" CRISP_ABI_KEY
      "'; rebuild it against this crisp with the same compiler flags");
  EXPECT_THAT(registrar.stages().names(), IsEmpty());
}

TEST(PluginLoader, TakesNothingFromAPluginOfWhichAStageIsRefused) {
  Registrar registrar;
  registrar.stage<toy::CountStage>();
  PluginLoader loader(registrar);
  loader.load(CLASHING_PLUGIN);
  EXPECT_THAT(loader.tried().at(0).refusal,
              AllOf(HasSubstr("there are two stages toy.count: one built in, one from "),
                    HasSubstr("; give one of them another name, or load only one of the two")));
  EXPECT_THAT(registrar.stages().names(), ElementsAre("toy.count"));
}

/// A registry of things that are not stages, as terms are.
struct Things {
  std::vector<std::string> names() const { return all; }
  std::vector<std::string> all;
};

TEST(PluginLoader, ListsWhatElseAPluginBrings) {
  Registrar registrar;
  Things things{.all = {"old"}};
  registrar.attach(things, "thing");
  registrar.stage<toy::SumStage>();
  const auto take_back = registrar.snapshot();
  registrar.stage<toy::CountStage>();
  things.all.emplace_back("new");
  EXPECT_THAT(registrar.registered(),
              ElementsAre("stage toy.count", "stage toy.sum", "thing new", "thing old"));
  take_back();
  EXPECT_THAT(registrar.registered(), ElementsAre("stage toy.sum", "thing old"));
}

TEST(PluginLoader, RefusesAPluginThatThrowsWhatIsNoException) {
  Registrar registrar;
  PluginLoader loader(registrar);
  loader.load(THROWING_PLUGIN);
  EXPECT_EQ(loader.tried().at(0).refusal, "its registration threw something that is no std::exception");
  EXPECT_THAT(registrar.stages().names(), IsEmpty());
}

TEST(PluginLoader, ReportsWhyAFileIsNoPlugin) {
  const fs::path text = fs::path(testing::TempDir()) / "crisp_not_a_plugin.so";
  write_file(text, "just text");
  Registrar registrar;
  PluginLoader loader(registrar);
  loader.load("/nowhere/x.so");
  loader.load(text);
  loader.load("libm.so.6");
  EXPECT_THAT(loader.tried()[0].refusal, HasSubstr("No such file"));
  EXPECT_THAT(loader.tried()[1].refusal, HasSubstr("it is no shared object for this machine"));
  EXPECT_FALSE(loader.tried()[2].is_loaded());  // searched here, and not in the system's folders
  fs::remove(text);
}

/// A copy of the toy plugin, or of its first bytes, in a folder of its own.
fs::path copy_of_toy(const std::string& name, std::uintmax_t bytes = fs::file_size(TOY_PLUGIN)) {
  fs::path copy = fs::path(testing::TempDir()) / name;
  fs::copy_file(TOY_PLUGIN, copy, fs::copy_options::overwrite_existing);
  fs::resize_file(copy, bytes);
  return copy;
}

TEST(PluginLoader, RefusesAPluginThatWasCutShortWhereverThatIs) {
  const auto whole = fs::file_size(TOY_PLUGIN);
  for (const auto bytes : {std::uintmax_t{80}, std::uintmax_t{9000}, whole / 2, whole - 1}) {
    const fs::path cut = copy_of_toy("crisp_cut.so", bytes);
    Registrar registrar;
    PluginLoader loader(registrar);
    loader.load(cut);
    EXPECT_THAT(loader.tried().at(0).refusal, HasSubstr("it is truncated: its "));
    EXPECT_THAT(loader.tried().at(0).refusal,
                HasSubstr("reach beyond its " + std::to_string(bytes) + " bytes; copy or build it again"));
    fs::remove(cut);
  }
}

TEST(PluginLoader, RefusesWhatIsNoFileWithoutOpeningIt) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "pipe.so").c_str(), 0600), 0);
  fs::create_symlink("/dev/zero", folder / "zeros.so");
  Registrar registrar;
  PluginLoader loader(registrar);
  loader.load(folder.path());
  ASSERT_EQ(loader.tried().size(), 2U);
  for (const auto& plugin : loader.tried())
    EXPECT_EQ(plugin.refusal, "it is no file, but a pipe, a device or a folder");
}

TEST(PluginLoader, RefusesAPluginForAnotherMachineAndAProgram) {
  const test::TemporaryFolder folder;
  std::string other = test::bytes_of(TOY_PLUGIN);
  other[18] = '\x28';  // e_machine
  test::put_bytes(folder / "other.so", other);
  Registrar registrar;
  PluginLoader loader(registrar);
  loader.load(folder / "other.so");
  EXPECT_EQ(loader.tried().at(0).refusal, "it is no shared object for this machine");
  std::string object = test::bytes_of(TOY_PLUGIN);
  object[16] = 1;  // e_type: a part of a program that is not linked yet
  test::put_bytes(folder / "object.so", object);
  loader.load(folder / "object.so");
  EXPECT_EQ(loader.tried().at(1).refusal, "it is no shared object, but a program or a part of one");
}

/// Each damaged plugin is loaded in a process of its own, which must come to its end.
TEST(PluginLoader, SurvivesAPluginWhoseHeadersAreDamaged) {
  const test::TemporaryFolder folder;
  const std::string sound = test::bytes_of(TOY_PLUGIN);
  constexpr std::size_t kHeaders = 64 + 10 * 56;  // [bytes] ELF's own, and those of ten segments
  for (std::size_t bit = 3; bit < 8 * kHeaders; bit += 37) {
    std::string damaged = sound;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << bit % 8));
    test::put_bytes(folder / "damaged.so", damaged);
    const pid_t child = fork();
    if (child == 0) {
      Registrar registrar;
      PluginLoader loader(registrar);
      loader.load(folder / "damaged.so");
      _exit(loader.tried().size() == 1 ? 0 : 1);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0)
        << "bit " << bit << ", signal " << WTERMSIG(status);
  }
}

TEST(PluginLoader, RefusesAPluginThatCrashesTheSystemsLoader) {
  const test::TemporaryFolder folder;
  std::string damaged = test::bytes_of(TOY_PLUGIN);
  // The dynamic section, from which the loader takes the addresses of all its tables.
  std::uint64_t begin = 0;
  std::uint64_t bytes = 0;
  for (std::size_t header = 64; bytes == 0; header += 56) {
    std::uint32_t type = 0;
    std::memcpy(&type, &damaged[header], sizeof type);
    if (type != 2) continue;  // PT_DYNAMIC
    std::memcpy(&begin, &damaged[header + 8], sizeof begin);
    std::memcpy(&bytes, &damaged[header + 32], sizeof bytes);
  }
  for (std::size_t entry = begin; entry < begin + bytes; entry += 16) damaged[entry + 14] = '\x7f';
  test::put_bytes(folder / "damaged.so", damaged);
  Registrar registrar;
  PluginLoader loader(registrar);
  loader.load(folder / "damaged.so");
  EXPECT_THAT(loader.tried().at(0).refusal, HasSubstr("it is damaged: a process that loads it ends "));
}

TEST(PluginLoader, WarnsOfAPluginThatEveryoneMayChange) {
  const test::TemporaryFolder folder;
  const fs::path file = folder / "toy.so";
  fs::copy_file(TOY_PLUGIN, file);
  const auto warning = [&] {
    Registrar registrar;
    PluginLoader loader(registrar);
    loader.load(file);
    EXPECT_TRUE(loader.tried().at(0).is_loaded());
    return loader.tried().at(0).warning;
  };
  EXPECT_EQ(warning(), "");
  fs::permissions(folder.path(), fs::perms::all);
  EXPECT_EQ(warning(), "everyone may write to its folder, " + folder.path().string());
  fs::permissions(folder.path(), fs::perms::all | fs::perms::sticky_bit);
  EXPECT_EQ(warning(), "");
  fs::permissions(file, fs::perms::others_write, fs::perm_options::add);
  EXPECT_EQ(warning(), "everyone may write to it");
}

TEST(PluginLoader, SkipsAPluginThatIsMetAgain) {
  const fs::path copy = copy_of_toy("crisp_again.so");
  Registrar registrar;
  PluginLoader loader(registrar);
  for (const auto& file : {fs::path(TOY_PLUGIN), copy, fs::path(TOY_PLUGIN)}) loader.load(file);
  EXPECT_TRUE(loader.tried().at(0).is_loaded());
  for (const std::size_t again : {1, 2}) {
    EXPECT_FALSE(loader.tried().at(again).is_loaded());
    EXPECT_EQ(loader.tried().at(again).refusal, "");
    EXPECT_EQ(loader.tried().at(again).skipped, loader.tried()[0].file);
  }
  fs::remove(copy);
}

TEST(PluginLoader, LetsThePreferredPluginOfANameCount) {
  const fs::path copy = copy_of_toy("crisp_preferred.so");
  Registrar registrar;
  PluginLoader loader(registrar);
  loader.prefer(copy);
  EXPECT_THAT(registrar.stages().names(), IsEmpty());
  loader.load(TOY_PLUGIN);
  loader.load(copy);
  EXPECT_EQ(loader.tried().at(0).skipped, copy);
  EXPECT_TRUE(loader.tried().at(1).is_loaded());
  EXPECT_EQ(registrar.stages().find("toy.write")->origin, "from " + copy.string());
  fs::remove(copy);
}

TEST(PluginLoader, TriesEverySharedObjectOfAFolder) {
  Registrar registrar;
  PluginLoader loader(registrar);
  loader.load(fs::path(TOY_PLUGIN).parent_path());
  std::vector<std::string> files;
  for (const auto& plugin : loader.tried()) files.push_back(plugin.file.filename().string());
  EXPECT_THAT(files,
              ElementsAre("clashing_plugin.so", "foreign_plugin.so", "throwing_plugin.so", "toy_plugin.so"));
}

}  // namespace
}  // namespace crisp
