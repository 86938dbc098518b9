// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// CDR by hand: alignment, both orders of the bytes, both versions, and definitions that are none.
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "log/message_numbers.hpp"
#include "log/ros2_definition.hpp"

namespace steerid {
namespace {

using Numbers = std::map<std::string, double>;

Numbers read(const MessageNumbers& numbers, const std::string& bytes, bool whole = true) {
  Numbers found;
  EXPECT_EQ(numbers.read(bytes, [&](std::string_view path, double value) { found[std::string(path)] = value; }), whole);
  return found;
}

using namespace std::string_literals;

TEST(Ros2Numbers, StandAtMultiplesOfTheirLength) {
  const auto numbers = ros2_numbers("a/msg/B", "uint8 small\nfloat64 wide\nint16 low\nbool yes");
  ASSERT_TRUE(numbers);
  // 1.5 is 3ff8000000000000.
  const std::string first = "\0\1\0\0"s + "\7\0\0\0\0\0\0\0"s + "\0\0\0\0\0\0\xf8\x3f"s + "\xfe\xff\1"s;
  const Numbers want = {{"small", 7}, {"wide", 1.5}, {"low", -2}, {"yes", 1}};
  EXPECT_EQ(read(*numbers, first), want);
  const std::string highest_first = "\0\0\0\0"s + "\7\0\0\0\0\0\0\0"s + "\x3f\xf8\0\0\0\0\0\0"s + "\xff\xfe\1"s;
  EXPECT_EQ(read(*numbers, highest_first), want);
  const std::string second = "\0\7\0\0"s + "\7\0\0\0"s + "\0\0\0\0\0\0\xf8\x3f"s + "\xfe\xff\1"s;
  EXPECT_EQ(read(*numbers, second), want);
  for (std::size_t length = 0; length < first.size(); ++length) (void)read(*numbers, first.substr(0, length), false);
  (void)read(*numbers, "\0\3"s + first.substr(2), false);  // a list of parameters is no plain CDR
}

TEST(Ros2Numbers, ListsTextsAndMessagesWithoutFields) {
  const auto numbers = ros2_numbers("a/B", "Empty nothing\nstring text\nint8[] few\nuint8[] many\nInner[2] two\n" +
                                               std::string(80, '=') + "\nMSG: a/Empty\n# none\n" +
                                               std::string(80, '=') + "\nMSG: a/Inner\nfloat32 x\n");
  ASSERT_TRUE(numbers);
  const std::string many(100, '\5');
  const std::string bytes = "\0\1\0\0"s + "\0\0\0\0\2\0\0\0h\0"s + "\0\0"s + "\2\0\0\0\xff\1\0\0"s + "\x64\0\0\0"s +
                            many + "\0\0\xc0\x3f\0\0\0\x40"s;
  const Numbers want = {{"few[0]", -1}, {"few[1]", 1}, {"two[0]/x", 1.5}, {"two[1]/x", 2}};
  EXPECT_EQ(read(*numbers, bytes), want);
}

TEST(Ros2Definition, IsRefusedWhereItCannotBeUnderstood) {
  for (const char* bad : {"wstring wide", "Missing field", "B field", "float64", "float64[0] none", "float64[-1] x",
                          "float64[x] y", "float64[99999999999999999999] y", "float64] y",
                          "C c\n================\nMSG: a/C\nD d\n================\nMSG: a/D\nC c"}) {
    EXPECT_FALSE(parse_ros2_definition("a/B", bad)) << bad;
  }
  const auto types = parse_ros2_definition("a/msg/B", "float64 LIMIT=3\r\nstring NAME = \"x\"\n\nfloat64[<=3] x 1\r\n");
  ASSERT_TRUE(types);
  ASSERT_EQ(types->front().size(), 1U);
  EXPECT_EQ(types->front()[0].name, "x");
  EXPECT_EQ(types->front()[0].count, Ros2Count::kAny);
}

}  // namespace
}  // namespace steerid
