#include "core/base/text.h"

#include <gtest/gtest.h>

namespace aftershade {
namespace {

using Strings = std::vector<std::string>;

TEST(Cat, JoinsTextAndShortestNumbers) {
  EXPECT_EQ(cat("a", 'b', std::string("c"), 1, -2L, 3U), "abc1-23");
  EXPECT_EQ(cat(0.1, " ", 0.1F, " ", 1.0, " ", 1e300), "0.1 0.1 1 1e+300");
  EXPECT_EQ(cat(), "");
}

TEST(Fixed, KeepsTheDigits) {
  EXPECT_EQ(fixed(1.0, 3), "1.000");
  EXPECT_EQ(fixed(-0.125, 2), "-0.12");  // ties to even
  EXPECT_EQ(fixed(2.5, 0), "2");
  EXPECT_EQ(fixed(1e300, 2).size(), 304U);
}

TEST(Split, KeepsEmptyParts) {
  EXPECT_EQ(split("a,b,,c", ','), (Strings{"a", "b", "", "c"}));
  EXPECT_EQ(split("", ','), Strings{""});
  EXPECT_EQ(split(",", ','), (Strings{"", ""}));
}

TEST(Join, UndoesSplit) {
  EXPECT_EQ(join(Strings{"a", "", "b"}, ", "), "a, , b");
  EXPECT_EQ(join(Strings{}, ", "), "");
  EXPECT_EQ(join(Strings{"", "b"}, ","), ",b");
}

TEST(ToLower, IsAscii) { EXPECT_EQ(to_lower("AbZ-9"), "abz-9"); }

TEST(ParseNumber, TakesTheWholeText) {
  EXPECT_EQ(parse_number("1.5"), 1.5);
  EXPECT_EQ(parse_number("+2"), 2.0);
  EXPECT_EQ(parse_number("-1e-3"), -1e-3);
  for (const char* text : {"", " 1", "1 ", "1,5", "1.5x", "0x10", "+", "--1", "e5"})
    EXPECT_EQ(parse_number(text), std::nullopt) << text;
}

TEST(ParseInteger, TakesTheWholeText) {
  EXPECT_EQ(parse_integer("-12"), -12);
  EXPECT_EQ(parse_integer("+7"), 7);
  EXPECT_EQ(parse_integer("007"), 7);
  for (const char* text : {"", "1.5", "1e3", "99999999999", "12a", " 1"})
    EXPECT_EQ(parse_integer(text), std::nullopt) << text;
}

TEST(GlobMatch, StarIsAnyRun) {
  for (const char* text : {"Combined.R", "View.combined.r", "combined.r"})
    EXPECT_TRUE(glob_match("*combined.R", text)) << text;
  EXPECT_TRUE(glob_match("*", ""));
  EXPECT_TRUE(glob_match("a*b*c", "aXbYbZc"));
  EXPECT_TRUE(glob_match("**a", "a"));
  EXPECT_FALSE(glob_match("a*b*c", "aXbYbZ"));
  EXPECT_FALSE(glob_match("", "a"));
  EXPECT_FALSE(glob_match("a", ""));
  EXPECT_FALSE(glob_match("abc", "abcd"));
  EXPECT_FALSE(glob_match("a.c", "abc"));
}

TEST(Nearest, FindsTypingErrorsOnly) {
  const Strings words{"radius_m", "scale", "taps"};
  EXPECT_EQ(nearest("radus_m", words), "radius_m");
  EXPECT_EQ(nearest("RADIUS_M", words), "radius_m");
  EXPECT_EQ(nearest("tap", words), "taps");
  EXPECT_EQ(nearest("scael", words), std::nullopt);  // two edits in five letters
  EXPECT_EQ(nearest("brightness", words), std::nullopt);
  EXPECT_EQ(nearest("", words), std::nullopt);
  EXPECT_EQ(nearest("x", Strings{}), std::nullopt);
}

TEST(Nearest, AnotherLetterIsNoTypingError) {
  EXPECT_EQ(nearest("Z", Strings{"Y"}), std::nullopt);
  EXPECT_EQ(nearest("", Strings{"Y"}), std::nullopt);
  EXPECT_EQ(nearest("z", Strings{"Y", "Z"}), "Z");
  EXPECT_EQ(nearest("a", Strings{"Z", "AO"}), "AO");
}

TEST(DidYouMean, AsksOrIsSilent) {
  EXPECT_EQ(did_you_mean("radus_m", Strings{"radius_m"}), "did you mean \"radius_m\"?");
  EXPECT_EQ(did_you_mean("brightness", Strings{"radius_m"}), "");
}

}  // namespace
}  // namespace aftershade
