// Control characters of untrusted text in messages, and paths that are not regular files
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "base/input_file.h"
#include "taut/diagnostics.h"
#include "taut/files.h"

namespace taut::test {
namespace {

TEST(UntrustedText, ControlCharactersArePrintedAsNumbers) {
  EXPECT_EQ(Printable("\x1b]0;title\x07"), "\\x1b]0;title\\x07");
  EXPECT_EQ(Printable("a\tb\nc"), "a\tb\nc");
  EXPECT_EQ(Printable("\r\x7f"), "\\x0d\\x7f");
  EXPECT_EQ(Printable("\xc2\x9b"
                      "31m"),
            "\\x9b31m")
      << "a control character of two bytes";
  EXPECT_EQ(Printable("\xc3\xa9\xc2\xb0"), "\xc3\xa9\xc2\xb0") << "letters are not";
  EXPECT_EQ(Printable("\xc2"), "\xc2");
}

TEST(UntrustedText, MarksOfTheTextDirectionArePrintedAsNumbers) {
  EXPECT_EQ(Printable("a\u202eb\u2066c\u061c\u200f"), "a\\u202eb\\u2066c\\u061c\\u200f");
  const std::string others = "\u0661\u20ac\u2013\u2070 \xe2\x80";
  EXPECT_EQ(Printable(others), others);
}

TEST(UntrustedText, NoMessageSteersATerminal) {
  Diagnostics out;
  out.Error("test.control", {"a\x1b[2J.csv", 1, 2}, "holds \x1b[31m", "use \x1b[0m");
  EXPECT_EQ(out.Format(), "a\\x1b[2J.csv:1:2: error: holds \\x1b[31m (use \\x1b[0m)\n");
}

TEST(UntrustedText, LongTextsLackTheirMiddle) {
  Diagnostics out;
  out.Error("test.long", {}, "first " + std::string(5'000'000, 'x') + " last");
  out.Error("test.short", {}, std::string(4000, 'x'));
  std::string letters;
  for (int i = 0; i < 3000; ++i) letters += "\xe2\x82\xac";
  out.Warning("test.letters", {}, letters, letters + "?");
  const std::string& what = out.items()[0].what;
  EXPECT_LT(what.size(), 4010u);
  EXPECT_TRUE(what.starts_with("first xxx") && what.ends_with("xxx last"));
  EXPECT_NE(what.find("x ... x"), std::string::npos);
  EXPECT_EQ(out.items()[1].what, std::string(4000, 'x'));
  for (const std::string& text : {out.warnings()[0].what, out.warnings()[0].hint}) {
    const std::size_t middle = text.find(" ... ");
    EXPECT_EQ(middle % 3, 0u) << "no letter is cut";
    EXPECT_EQ(text.substr(middle + 5, 3), "\xe2\x82\xac");
  }
}

TEST(UntrustedText, HintsCompareNamesOfSimilarLengthOnly) {
  EXPECT_EQ(ClosestMatch("radius", {"radius_m"}), "radius_m");
  EXPECT_EQ(ClosestMatch("radius", {"radius_of_the_first_of_all_rods"}), "");
  EXPECT_EQ(ClosestMatch(std::string(101, 'a'), {std::string(101, 'a')}), "");
}

class InputFile : public testing::Test {
 protected:
  InputFile() {
    std::string pattern = (std::filesystem::temp_directory_path() / "taut_input_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~InputFile() override { std::filesystem::remove_all(folder_); }
  std::string Complaint(const std::string& path, std::size_t most_bytes = 1 << 20) {
    Diagnostics out;
    EXPECT_FALSE(base::ReadInputFile(path, most_bytes, "", out));
    return out.Format();
  }
  std::string folder_;
};

TEST_F(InputFile, PipesAndDevicesThatAFileNamesAreRefusedWithoutOpeningThem) {
  const std::string pipe = folder_ + "/pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const std::string at_socket = folder_ + "/socket";
  const int listener = socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  at_socket.copy(address.sun_path, sizeof address.sun_path - 1);
  ASSERT_EQ(bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  close(listener);
  for (const std::string& path :
       {pipe, at_socket, std::string("/dev/zero"), std::string("/dev/null")}) {
    EXPECT_EQ(Complaint(path),
              path + ": error: the path is a pipe, socket or device (expected a regular file)\n");
  }
}

TEST_F(InputFile, AUserMayNameAPipe) {
  Diagnostics out;
  const auto text = base::ReadInputFile("/dev/null", 10, "", out, base::NamedBy::kUser);
  ASSERT_TRUE(text) << out.Format();
  EXPECT_EQ(*text, "");
}

TEST_F(InputFile, APipeWithoutAWriterIsAnError) {
  const std::string pipe = folder_ + "/pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  Diagnostics out;
  EXPECT_FALSE(base::ReadInputFile(pipe, 10, "", out, base::NamedBy::kUser));
  EXPECT_EQ(out.Format(),
            pipe + ": error: cannot open: no other program has opened this pipe within 5 s\n");
  Diagnostics written;
  EXPECT_FALSE(WriteWholeFile(pipe, "text", written));
  EXPECT_EQ(written.Format(),
            pipe + ": error: cannot write: no other program has opened this pipe within 5 s\n");
}

TEST_F(InputFile, TheWriterOfAPipeMayBeLateAndSlow) {
  const std::string pipe = folder_ + "/pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  std::thread writer([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    std::ofstream file(pipe);
    for (const char* const part : {"a slow ", "writer"}) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      file << part << std::flush;
    }
  });
  Diagnostics out;
  const auto text = base::ReadInputFile(pipe, 100, "", out, base::NamedBy::kUser);
  writer.join();
  ASSERT_TRUE(text) << out.Format();
  EXPECT_EQ(*text, "a slow writer");
}

TEST_F(InputFile, AnAnonymousPipeIsReadToItsEnd) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);  // an anonymous pipe, as of a shell's <(...)
  ASSERT_EQ(write(ends[1], "text", 4), 4);
  close(ends[1]);
  Diagnostics out;
  const auto text =
      base::ReadInputFile("/dev/fd/" + std::to_string(ends[0]), 10, "", out, base::NamedBy::kUser);
  close(ends[0]);
  ASSERT_TRUE(text) << out.Format();
  EXPECT_EQ(*text, "text");
}

TEST_F(InputFile, TooLargeAFileIsRefusedBeforeItIsRead) {
  const std::string path = folder_ + "/large";
  std::ofstream(path) << "x";
  std::filesystem::resize_file(path, std::uintmax_t{1} << 40);  // sparse
  EXPECT_EQ(Complaint(path, 5'000'000), path + ": error: the file is larger than 5 MB\n");
}

}  // namespace
}  // namespace taut::test
