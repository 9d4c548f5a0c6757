// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iterator>

#include <crisp/atomic_file.hpp>
#include <crisp/error.hpp>

namespace crisp {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class AtomicFileTest : public testing::Test {
 protected:
  AtomicFileTest() {
    std::string pattern = (fs::temp_directory_path() / "crisp-XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~AtomicFileTest() override { fs::remove_all(folder_); }

  static std::string content(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  std::ptrdiff_t entries() const { return std::distance(fs::directory_iterator(folder_), {}); }

  fs::path folder_;
};

TEST_F(AtomicFileTest, TakesItsNameOnlyWhenItIsComplete) {
  const fs::path file = folder_ / "new" / "x.txt";
  AtomicFile out(file);
  out.write("half");
  EXPECT_FALSE(fs::exists(file));
  out.write(" and half");
  out.commit();
  EXPECT_EQ(content(file), "half and half");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "new"), {}), 1);
}

TEST_F(AtomicFileTest, RewritesItsBeginAndGoesOnBehindItsEnd) {
  const fs::path file = folder_ / "x.txt";
  AtomicFile out(file);
  out.write("0 points: ");
  out.write("a, ");
  out.rewrite(0, "2");
  out.write("b");
  out.commit();
  EXPECT_EQ(content(file), "2 points: a, b");
}

TEST_F(AtomicFileTest, ReadsWhatWasWrittenAndGoesOnBehindItsEnd) {
  const fs::path file = folder_ / "x.txt";
  AtomicFile out(file);
  out.write("one, two");
  std::string read(3, ' ');
  out.read(5, read);
  EXPECT_EQ(read, "two");
  out.write(", three");
  EXPECT_THROW(out.read(14, read), Error);
  out.commit();
  EXPECT_EQ(content(file), "one, two, three");
}

TEST_F(AtomicFileTest, LeavesNothingBehindWhenItIsGivenUp) {
  const fs::path file = folder_ / "x.txt";
  write_file(file, "old");
  {
    AtomicFile out(file);
    out.write("new");
  }
  EXPECT_EQ(content(file), "old");
  EXPECT_EQ(entries(), 1);
}

TEST_F(AtomicFileTest, LeavesNoRecordOfTheFileThatItReplaces) {
  const fs::path file = folder_ / "x.txt";
  const fs::path record = folder_ / "x.txt.provenance.json";
  write_file(file, "old");
  write_file(record, "{}");
  AtomicFile out(file);
  out.write("new");
  EXPECT_TRUE(fs::exists(record)) << "the old file is still there";
  out.commit();
  EXPECT_EQ(content(file), "new");
  EXPECT_FALSE(fs::exists(record));
}

TEST_F(AtomicFileTest, CommitsWhatALibraryWroteAside) {
  AtomicFile out(folder_ / "x.txt");
  fs::remove(out.aside());
  std::ofstream(out.aside()) << "by another hand";
  out.commit();
  EXPECT_EQ(content(folder_ / "x.txt"), "by another hand");
}

TEST_F(AtomicFileTest, ReplacesALinkAndLeavesTheFileThatItLeadsTo) {
  write_file(folder_ / "target", "old");
  for (const char* target : {"target", "none"}) {
    fs::remove(folder_ / "link");
    fs::create_symlink(target, folder_ / "link");
    write_file(folder_ / "link", "new");
    EXPECT_FALSE(fs::is_symlink(folder_ / "link"));
    EXPECT_EQ(content(folder_ / "link"), "new");
  }
  EXPECT_EQ(content(folder_ / "target"), "old");
  EXPECT_FALSE(fs::exists(folder_ / "none"));
}

TEST_F(AtomicFileTest, RefusesToReplaceWhatIsNotAFile) {
  fs::create_symlink("/dev/null", folder_ / "null");
  fs::create_symlink("/proc/self/fd/1", folder_ / "stdout");
  for (const fs::path& target : {fs::path("/dev/null"), folder_, folder_ / "null", folder_ / "stdout"}) {
    try {
      write_file(target, "x");
      FAIL() << target;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(),
                  HasSubstr("cannot write " + target.string() + ": it is there and is not a file"));
    }
  }
}

TEST_F(AtomicFileTest, NamesTheFileWhenItsFolderCannotBeMade) {
  write_file(folder_ / "file", "x");
  try {
    write_file(folder_ / "file" / "below.txt", "x");
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr((folder_ / "file" / "below.txt").string()));
  }
}

/// In a process of its own that may write no more than 4096 bytes to a file, as on a full disk.
TEST_F(AtomicFileTest, NamesTheFileAndKeepsTheOldOneWhenTheDiskIsFull) {
  const fs::path file = folder_ / "big.txt";
  write_file(file, "old");
  const pid_t child = fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit = {4096, 4096};
    setrlimit(RLIMIT_FSIZE, &limit);
    try {
      write_file(file, std::string(1 << 20, 'x'));
    } catch (const Error& error) {
      _exit(std::string(error.what()).find(file.string()) != std::string::npos ? 42 : 1);
    }
    _exit(2);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(WEXITSTATUS(status), 42);
  EXPECT_EQ(content(file), "old");
  EXPECT_EQ(entries(), 1);
}

}  // namespace
}  // namespace crisp
