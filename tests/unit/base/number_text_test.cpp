// Conversion of numbers and text without std::from_chars and std::to_chars of doubles, compared
// with them. It is compiled into this program, where its functions replace those in taut::base.
#include "base/number_text.h"

#include <gtest/gtest.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>

namespace taut::test {
namespace {

std::string Shortest(double number) {
  char text[512];
  return {text, base::ToChars(text, text + sizeof text, number).ptr};
}
std::string ShortestOfStd(double number) {
  char text[512];
  return {text, std::to_chars(text, text + sizeof text, number).ptr};
}

void ExpectSameText(double number) {
  ASSERT_EQ(Shortest(number), ShortestOfStd(number));
  for (const int digits : {1, 4, 17}) {
    char ours[64], theirs[64];
    const std::string text(ours, base::ToChars(ours, ours + 64, number, digits).ptr);
    const auto end = std::to_chars(theirs, theirs + 64, number, std::chars_format::general, digits);
    ASSERT_EQ(text, std::string(theirs, end.ptr));
  }
}

void ExpectSameNumber(const std::string& text) {
  double ours = 12.5, theirs = 12.5;
  const char* const begin = text.data();
  const auto a = base::FromChars(begin, begin + text.size(), ours);
  const auto b = std::from_chars(begin, begin + text.size(), theirs);
  ASSERT_EQ(a.ec, b.ec) << text;
  ASSERT_EQ(a.ptr - begin, b.ptr - begin) << text;
  if (std::isnan(theirs)) {
    ASSERT_TRUE(std::isnan(ours)) << text;
  } else {
    ASSERT_EQ(std::bit_cast<std::uint64_t>(ours), std::bit_cast<std::uint64_t>(theirs)) << text;
  }
}

TEST(NumberTextByHand, PrintsWhatTheStandardLibraryPrints) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 20000; ++i) {
    const double number = std::bit_cast<double>(random());
    if (!std::isnan(number)) ExpectSameText(number);
    // numbers as in files
    ExpectSameText(static_cast<double>(static_cast<std::int64_t>(random() % 2000000) - 1000000) /
                   std::pow(10.0, static_cast<double>(random() % 12)));
  }
  for (const double number :
       {0.0, -0.0, 1.0, 0.1, 100.0, 1e5, 12345.0, 1e22, 1e23, 123456789012345680.0, 1e-5, 1e-4,
        5e-324, std::numeric_limits<double>::max(), std::numeric_limits<double>::infinity(),
        -std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    ExpectSameText(number);
  }
}

TEST(NumberTextByHand, PrintsPowersOfTwoWhichHaveUnequalNeighbours) {
  for (int exponent = -1074; exponent < 1024; ++exponent) ExpectSameText(std::ldexp(1.0, exponent));
}

TEST(NumberTextByHand, SaysWhenThereIsNoRoom) {
  char text[4];
  EXPECT_EQ(base::ToChars(text, text + 4, 0.125).ec, std::errc::value_too_large);
  EXPECT_EQ(base::ToChars(text, text + 4, 1234.5, 5).ec, std::errc::value_too_large);
  EXPECT_EQ(base::ToChars(text, text + 4, 0.25).ptr, text + 4);
}

TEST(NumberTextByHand, ReadsWhatTheStandardLibraryReads) {
  std::mt19937_64 random(11);
  for (int i = 0; i < 20000; ++i) {
    const double number = std::bit_cast<double>(random());
    ExpectSameNumber(ShortestOfStd(number));
    char text[64];
    const auto end = std::to_chars(text, text + 64, number, std::chars_format::scientific, 20);
    ExpectSameNumber({text, end.ptr});
  }
  for (const char* text : {"",
                           "-",
                           "+1",
                           " 1",
                           "1 ",
                           "1.",
                           ".5",
                           ".",
                           "-.5",
                           "-.",
                           "1e",
                           "1e+",
                           "1e-",
                           "1e5",
                           "1E+5",
                           "1e-5x",
                           "0x10",
                           "0x",
                           "1,5",
                           "1.2.3",
                           "1e400",
                           "-1e400",
                           "1e-400",
                           "-1e-400",
                           "0e400",
                           "0.000e-999",
                           "inf",
                           "-inf",
                           "INF",
                           "infinity",
                           "infinit",
                           "infinityx",
                           "nan",
                           "NaN",
                           "-nan",
                           "nan()",
                           "nan(12_aZ)",
                           "nan(",
                           "nan(-)",
                           "nanx",
                           "in",
                           "na",
                           "--1",
                           "1-",
                           "1e5.5",
                           "00012",
                           "1_000",
                           "4.9e-324",
                           "2e-324",
                           "3e-324",
                           "2.2250738585072011e-308",
                           "9007199254740993",
                           "1.7976931348623159e308",
                           "1e22",
                           "1e23",
                           "é"}) {
    ExpectSameNumber(text);
  }
}

TEST(NumberTextByHand, ReadsNothingBehindTheEnd) {
  const std::string text = "12345";
  double number = 0;
  const auto read = base::FromChars(text.data(), text.data() + 3, number);
  EXPECT_EQ(number, 123);
  EXPECT_EQ(read.ptr, text.data() + 3);
}

}  // namespace
}  // namespace taut::test
