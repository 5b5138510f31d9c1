// Text for terminals: nothing in it acts on the terminal, and everything else stays.
#include "io/printable.h"

#include <gtest/gtest.h>

#include <random>

namespace lobelia {
namespace {

using namespace std::string_literals;

TEST(Printable, PlainTextStays) {
    for (const std::string text :
         {"", "a b", "C:\\new\\x1b", "\u00e4\u00df\u20ac\U0001f308", "\u05d0\u0627", "\u00a0"}) {
        EXPECT_EQ(printable(text), text);
        EXPECT_TRUE(is_utf8(text));
    }
}

TEST(Printable, EveryControlCharacterIsEscaped) {
    for (int c = 0; c < 0x20; ++c) EXPECT_EQ(printable(std::string(1, static_cast<char>(c)))[0], '\\') << c;
    EXPECT_EQ(printable("\x1b[31m\x7f"), "\\x1b[31m\\x7f");
    EXPECT_EQ(printable("a\nb\tc\rd\0e"s), "a\\nb\\tc\\rd\\x00e");
    EXPECT_EQ(printable("\u0085\u009b31m"), "\\u0085\\u009b31m");
    EXPECT_EQ(printable("\u202egpj.exe\u2066\u200f\u061c\u2028"), "\\u202egpj.exe\\u2066\\u200f\\u061c\\u2028");
}

TEST(Printable, LineBreaksStayOnlyIfAsked) {
    EXPECT_EQ(printable("a\nb\n", LineBreaks::kept), "a\nb\n");
    EXPECT_EQ(printable("a\r\n\x1b", LineBreaks::kept), "a\\r\n\\x1b");
}

TEST(Printable, BytesThatAreNotUtf8AreEscaped) {
    EXPECT_EQ(printable("a\xff"), "a\\xff");
    EXPECT_EQ(printable("\x9b"
                        "31m"),
              "\\x9b31m");
    // Overlong forms, surrogates, beyond Unicode, cut off, a continuation byte alone.
    for (const std::string bad : {"\xc0\x80", "\xc1\xbf", "\xe0\x80\x9b", "\xf0\x80\x80\x9b", "\xed\xa0\x80",
                                  "\xf4\x90\x80\x80", "\xf5\x80\x80\x80", "\xe2\x82", "\xf0\x9f\x8c", "\x80"}) {
        EXPECT_FALSE(is_utf8(bad));
        EXPECT_EQ(printable(bad).size(), 4 * bad.size()) << printable(bad);
    }
    EXPECT_TRUE(is_utf8("\xed\x9f\xbf\xee\x80\x80\xf4\x8f\xbf\xbf\xe0\xa0\x80\xf0\x90\x80\x80\xc2\x80"));
}

TEST(Printable, AnyBytesBecomeUtf8WithoutControlCharacters) {
    std::mt19937 generator(3);
    for (int round = 0; round < 2000; ++round) {
        std::string text(generator() % 40, ' ');
        for (char& c : text) c = static_cast<char>(generator());
        const std::string shown = printable(text);
        EXPECT_TRUE(is_utf8(shown));
        for (const char c : shown) EXPECT_TRUE(static_cast<unsigned char>(c) >= 0x20 && c != 0x7f);
        EXPECT_EQ(printable(shown), shown);
    }
}

}  // namespace
}  // namespace lobelia
