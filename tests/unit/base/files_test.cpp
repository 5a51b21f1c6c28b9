// Atomic file writes, and folders with a single writer
#include "taut/files.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include "tests/unit/trace/trace_fixture.h"

namespace taut::test {
namespace {

namespace fs = std::filesystem;

struct Files : TraceFolder {
  /// Returns the errors of writing `text`, and checks that the folder is unchanged.
  std::string Complaint(const std::string& path, const std::string& text) const {
    const std::vector<std::string> before = Names();
    Diagnostics out;
    EXPECT_FALSE(WriteWholeFile(path, text, out));
    EXPECT_EQ(Names(), before);
    return WithoutFolder(out.Format());
  }

  void ExpectWritten(const std::string& path, const std::string& text) const {
    Diagnostics out;
    EXPECT_TRUE(WriteWholeFile(path, text, out)) << out.Format();
    EXPECT_EQ(ReadFile(path), text);
  }
};

TEST_F(Files, AreReplacedWhole) {
  const std::string big(3'000'000, 'x');
  ExpectWritten(Path("a"), big);
  ExpectWritten(Path("a"), "short");
  ExpectWritten(Path("a"), "");
  EXPECT_EQ(Names(), std::vector<std::string>{"a"});
}

TEST_F(Files, AreOldUntilTheyAreNew) {
  WriteFile("a", "old");
  {
    NewFile file(Path("a"));
    ASSERT_TRUE(file.Create() && file.Write("ne"));
    EXPECT_EQ(ReadFile(Path("a")), "old");
    EXPECT_EQ(Names().size(), 2u);
  }
  EXPECT_EQ(Names(), std::vector<std::string>{"a"}) << "given up";
  NewFile file(Path("a"));
  ASSERT_TRUE(file.Create() && file.Write("ne"));
  ASSERT_TRUE(file.Publish() && file.Publish());
  ASSERT_TRUE(file.Write("w") && file.Sync());
  EXPECT_EQ(ReadFile(Path("a")), "new");
}

TEST_F(Files, GrowByAllOrNone) {
  const pid_t pid = fork();
  if (pid == 0) {
    NewFile file(Path("a"));
    const rlimit size{10, 1000}, more{1000, 1000};
    setrlimit(RLIMIT_FSIZE, &size);
    signal(SIGXFSZ, SIG_IGN);
    const bool full = file.Create() && file.Publish() && file.WriteAllOrNone("1234567\n") &&
                      !file.WriteAllOrNone("abcdefg\n") && file.why() == "File too large" &&
                      ReadFile(Path("a")) == "1234567\n";
    setrlimit(RLIMIT_FSIZE, &more);
    _exit(full && file.WriteAllOrNone("89\n") ? 0 : 1);
  }
  int status = -1;
  waitpid(pid, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(ReadFile(Path("a")), "1234567\n89\n");
}

TEST_F(Files, ThatCannotBeWrittenSayWhyAndStayAsTheyWere) {
  WriteFile("a", "old");
  fs::create_directory(Path("folder"));
  EXPECT_EQ(Complaint(Path("none/a"), "x"),
            "none/a: error: cannot write: No such file or directory\n");
  EXPECT_EQ(Complaint(Path("folder"), "x"), "folder: error: cannot write: Is a directory\n");
  const pid_t pid = fork();
  if (pid == 0) {  // a limit of the file size acts like a full disk
    const rlimit size{1000, 1000};
    setrlimit(RLIMIT_FSIZE, &size);
    signal(SIGXFSZ, SIG_IGN);
    const std::string full = Complaint(Path("a"), std::string(2000, 'x'));
    _exit(full == "a: error: cannot write: File too large\n" && !HasFailure() ? 0 : 1);
  }
  int status = -1;
  waitpid(pid, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(ReadFile(Path("a")), "old");
}

TEST_F(Files, DoNotFollowLinks) {
  WriteFile("victim", "untouched");
  fs::create_symlink("victim", Path("a"));
  // likewise under the name of the temporary file
  fs::create_symlink("victim", Path("a." + std::to_string(getpid()) + ".part"));
  ExpectWritten(Path("a"), "new");
  EXPECT_FALSE(fs::is_symlink(Path("a")));
  EXPECT_EQ(ReadFile(Path("victim")), "untouched");
}

TEST_F(Files, WhatIsNoFileIsWrittenTo) {
  ASSERT_EQ(mkfifo(Path("pipe").c_str(), 0600), 0);
  const int end = open(Path("pipe").c_str(), O_RDONLY | O_NONBLOCK);
  Diagnostics out;
  EXPECT_TRUE(WriteWholeFile(Path("pipe"), "through", out)) << out.Format();
  char text[8] = {};
  EXPECT_EQ(read(end, text, sizeof text), 7);
  EXPECT_STREQ(text, "through");
  close(end);
  EXPECT_TRUE(fs::is_fifo(Path("pipe")));
  EXPECT_TRUE(WriteWholeFile("/dev/null", "gone", out)) << out.Format();
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  if (access("/dev/full", W_OK) != 0) return;
  EXPECT_EQ(Complaint("/dev/full", "x"),
            "/dev/full: error: cannot write: No space left on device\n");
}

TEST_F(Files, AStreamThatIsAFileIsWrittenTo) {
  const int stream = open(Path("stream").c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
  Diagnostics out;
  for (const char* folder : {"/dev/fd/", "/proc/self/fd/"}) {
    EXPECT_TRUE(WriteWholeFile(folder + std::to_string(stream), "a", out)) << out.Format();
  }
  close(stream);
  EXPECT_EQ(ReadFile(Path("stream")), "aa");
}

TEST_F(Files, AFolderInMemoryIsOneAsAnyOther) {
  std::string folder = "/dev/shm/taut_files_XXXXXX";
  if (mkdtemp(folder.data()) == nullptr) GTEST_SKIP() << "this machine has no /dev/shm";
  ExpectWritten(folder + "/a", "new");
  fs::remove_all(folder);
}

TEST_F(Files, AFolderHasOneWriter) {
  Diagnostics out;
  auto first = FolderLock::Take(Path("a/b"), out);
  ASSERT_TRUE(first) << out.Format();
  EXPECT_TRUE(first->Holds());
  EXPECT_FALSE(FolderLock::Take(Path("a/b"), out));
  EXPECT_EQ(WithoutFolder(out.Format()),
            "a/b: error: another process is writing into this folder (wait for it, stop it, or "
            "give `--out` another folder)\n");
  first.reset();
  Diagnostics good;
  first = FolderLock::Take(Path("a/b"), good);
  ASSERT_TRUE(first) << good.Format();
  fs::remove_all(Path("a/b"));
  EXPECT_FALSE(first->Holds());
  const auto second = FolderLock::Take(Path("a/b"), good);
  ASSERT_TRUE(second) << good.Format();
  EXPECT_FALSE(first->Holds()) << "it is another folder now";
  EXPECT_TRUE(second->Holds());
}

TEST_F(Files, AFolderThatCannotBeMadeOrWrittenSaysWhy) {
  WriteFile("file", "");
  Diagnostics out;
  EXPECT_FALSE(FolderLock::Take(Path("file/a"), out));
  EXPECT_EQ(WithoutFolder(out.Format()),
            "file/a: error: cannot create the folder: Not a directory\n");
  fs::create_directory(Path("a"));
  fs::create_symlink("../file", Path("a/.lock"));
  Diagnostics link;
  EXPECT_FALSE(FolderLock::Take(Path("a"), link));
  EXPECT_EQ(WithoutFolder(link.Format()),
            "a: error: cannot write to the folder: Too many levels of symbolic links\n");
}

}  // namespace
}  // namespace taut::test
