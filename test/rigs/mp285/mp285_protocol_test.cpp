#include "rigs/mp285/mp285_protocol.h"

#include <gtest/gtest.h>

namespace microinjection {
namespace {

using Kind = Mp285Answer::Kind;
using Expected = Mp285Parser::Expected;

std::string bytes(std::initializer_list<int> values) {
  std::string text;
  for (const int value : values) text += static_cast<char>(value);
  return text;
}

TEST(Mp285Protocol, EncodesCommands) {
  EXPECT_EQ(mp285AskPosition(), bytes({0x63, 0x0d}));
  EXPECT_EQ(mp285AskStatus(), bytes({0x73, 0x0d}));
  EXPECT_EQ(mp285AbsoluteMode(), bytes({0x61, 0x0d}));
  EXPECT_EQ(kMp285Stop, 0x03);
  // 1000 = 0x3e8; -2 = 0xfffffffe; 16909060 = 0x01020304: the low byte first.
  EXPECT_EQ(mp285Move({1000, -2, 16909060}),
            bytes({0x6d, 0xe8, 0x03, 0, 0, 0xfe, 0xff, 0xff, 0xff, 0x04, 0x03, 0x02, 0x01, 0x0d}));
  EXPECT_EQ(mp285SetVelocity(1000, false), bytes({0x56, 0xe8, 0x03, 0x0d}));
  EXPECT_EQ(mp285SetVelocity(1000, true), bytes({0x56, 0xe8, 0x83, 0x0d}));
}

std::optional<Mp285Answer> answer(Expected expected, const std::string& text, bool silent = false) {
  Mp285Parser parser;
  parser.expect(expected);
  std::optional<Mp285Answer> result;
  for (std::size_t i = 0; i < text.size() && !result; ++i) result = parser.feed(text.substr(i, 1), false);
  return result || !silent ? result : parser.feed("", true);
}

TEST(Mp285Protocol, ReadsAPosition) {
  const auto said = answer(Expected::kPosition, bytes({0xe8, 0x03, 0, 0, 0xfe, 0xff, 0xff, 0xff, 4, 3, 2, 1, 0x0d}));
  ASSERT_TRUE(said && said->kind == Kind::kPosition);
  EXPECT_EQ(said->position, (Mp285Position{1000, -2, 16909060}));
}

TEST(Mp285Protocol, ACarriageReturnInAPositionIsANumber) {
  // 0x0d04 looks like the error 4 until the rest has come.
  const auto said = answer(Expected::kPosition, bytes({4, 0x0d, 0, 0, 0x0d, 0x0d, 0x0d, 0x0d, 0, 0, 0, 0, 0x0d}));
  ASSERT_TRUE(said && said->kind == Kind::kPosition);
  EXPECT_EQ(said->position, (Mp285Position{0x0d04, 0x0d0d0d0d, 0}));
}

TEST(Mp285Protocol, ReadsErrorsInBothForms) {
  for (const int code : {0, 1, 2, 4, 8}) {
    for (const int said : {code, '0' + code}) {
      const auto done = answer(Expected::kDone, bytes({said, 0x0d}));
      ASSERT_TRUE(done && done->kind == Kind::kError) << said;
      EXPECT_EQ(done->error, code);
      EXPECT_FALSE(answer(Expected::kPosition, bytes({said, 0x0d})));  // perhaps there is more
      const auto position = answer(Expected::kPosition, bytes({said, 0x0d}), true);
      ASSERT_TRUE(position && position->kind == Kind::kError) << said;
      EXPECT_EQ(position->error, code);
    }
  }
}

TEST(Mp285Protocol, ReadsTheAnswersToAStop) {
  EXPECT_EQ(answer(Expected::kDone, bytes({0x0d}))->kind, Kind::kDone);
  EXPECT_EQ(answer(Expected::kDone, bytes({0x3d, 0x0d}))->kind, Kind::kStopped);
  EXPECT_FALSE(answer(Expected::kDone, bytes({0x3d})));
}

TEST(Mp285Protocol, ReadsTheStatus) {
  std::string status(33, '\0');
  status[0] = 0x20;
  status[24] = 25;
  status[28] = static_cast<char>(0xe8);
  status[29] = static_cast<char>(0x83);
  status[32] = '\r';
  const auto said = answer(Expected::kStatus, status);
  ASSERT_TRUE(said && said->kind == Kind::kStatus);
  EXPECT_DOUBLE_EQ(said->status.microstep, 0.04e-6);
  EXPECT_TRUE(said->status.fine && said->status.absolute);
  EXPECT_EQ(said->status.speed, 1000);
  status[24] = 0;
  EXPECT_EQ(answer(Expected::kStatus, status)->kind, Kind::kMalformed);
}

TEST(Mp285Protocol, RefusesWhatIsNoAnswer) {
  EXPECT_EQ(answer(Expected::kPosition, std::string(13, 'x'))->kind, Kind::kMalformed);
  EXPECT_EQ(answer(Expected::kPosition, std::string(7, 'x'), true)->kind, Kind::kMalformed);
  EXPECT_EQ(answer(Expected::kPosition, "\r", true)->kind, Kind::kMalformed);
  EXPECT_EQ(answer(Expected::kDone, "xy")->kind, Kind::kMalformed);
  EXPECT_EQ(answer(Expected::kDone, bytes({3, 0x0d}))->kind, Kind::kMalformed);
  EXPECT_EQ(answer(Expected::kStatus, std::string(33, 'x'))->kind, Kind::kMalformed);
}

}  // namespace
}  // namespace microinjection
