// What a file's text looks like in a message.
#include "capture/source_text.hpp"

#include <gtest/gtest.h>

namespace nutik {
namespace {

TEST(Printable, KeepsCharactersOfEveryLength) {
  for (const std::string text :
       {"plain", "\u00e9t\u00e9", "\u65e5\u672c.tik", "a\U0001F600b", "\u00e9", "\U0001F600"}) {
    EXPECT_EQ(printable(text), text);
  }
}

TEST(Printable, ShowsBytesThatAreNoUtf8) {
  EXPECT_EQ(printable("\xe9t\xe9"), "\\xe9t\\xe9") << "Latin-1";
  EXPECT_EQ(printable("\xc3"), "\\xc3") << "cut off";
  EXPECT_EQ(printable("\xf0\x9f\x98"), "\\xf0\\x9f\\x98") << "cut off";
  EXPECT_EQ(printable("\xc0\xaf"), "\\xc0\\xaf") << "longer than it need be";
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80") << "a surrogate";
}

}  // namespace
}  // namespace nutik
