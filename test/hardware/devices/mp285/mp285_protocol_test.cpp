#include "hardware/devices/mp285/mp285_protocol.h"

#include <gtest/gtest.h>

namespace microinjection {
namespace {

using Kind = Mp285Reply::Kind;
using Expected = Mp285Parser::Expected;

std::string bytes(std::initializer_list<int> values) {
  std::string text;
  for (const int value : values) text += static_cast<char>(value);
  return text;
}

TEST(Mp285Protocol, EncodesCommands) {
  EXPECT_EQ(mp285RequestPosition(), bytes({0x63, 0x0d}));
  EXPECT_EQ(mp285RequestStatus(), bytes({0x73, 0x0d}));
  EXPECT_EQ(mp285AbsoluteMode(), bytes({0x61, 0x0d}));
  EXPECT_EQ(kMp285Stop, 0x03);
  // 1000 = 0x3e8; -2 = 0xfffffffe; 16909060 = 0x01020304: the low byte first.
  EXPECT_EQ(mp285Move({1000, -2, 16909060}),
            bytes({0x6d, 0xe8, 0x03, 0, 0, 0xfe, 0xff, 0xff, 0xff, 0x04, 0x03, 0x02, 0x01, 0x0d}));
  EXPECT_EQ(mp285SetVelocity(1000, false), bytes({0x56, 0xe8, 0x03, 0x0d}));
  EXPECT_EQ(mp285SetVelocity(1000, true), bytes({0x56, 0xe8, 0x83, 0x0d}));
}

std::optional<Mp285Reply> answer(Expected expected, const std::string& text, bool silent = false) {
  Mp285Parser parser;
  parser.expect(expected);
  std::optional<Mp285Reply> result;
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

TEST(Mp285Protocol, ReadsErrorsAndTheirSumsInBothForms) {
  for (int code = 0; code <= 15; ++code) {
    for (const int said : {code, '0' + code}) {
      if (said == 0x0d) continue;  // bare, it is the end of an answer
      const auto done = answer(Expected::kDone, bytes({said, 0x0d}));
      ASSERT_TRUE(done && done->kind == Kind::kError) << said;
      EXPECT_EQ(done->error, code);
      EXPECT_FALSE(answer(Expected::kPosition, bytes({said, 0x0d})));  // perhaps there is more
      const auto position = answer(Expected::kPosition, bytes({said, 0x0d}), true);
      ASSERT_TRUE(position && position->kind == Kind::kError) << said;
      EXPECT_EQ(position->error, code);
    }
  }
  EXPECT_EQ(mp285ErrorName(1 + 8), "frame error on the line, the move was interrupted");
  EXPECT_EQ(mp285ErrorName(0), "a byte was overrun");
}

TEST(Mp285Protocol, ReadsTheAnswersToAStop) {
  EXPECT_EQ(answer(Expected::kStop, bytes({0x0d}))->kind, Kind::kDone);
  EXPECT_EQ(answer(Expected::kStop, bytes({0x3d, 0x0d}))->kind, Kind::kStopped);
  EXPECT_FALSE(answer(Expected::kStop, bytes({0x3d})));
  EXPECT_EQ(answer(Expected::kDone, bytes({0x3d, 0x0d}))->error, 1 + 4 + 8);  // to anything else
}

/// As a public client printed them of a real MP-285.
const std::string kRealStatus = bytes({64, 0,  2,  4,  7, 0, 99, 0,  99, 0, 20, 0,   136, 19, 1, 120, 112,
                                       23, 16, 39, 80, 0, 0, 0,  25, 0,  4, 0,  200, 0,   84, 1, 0x0d});

TEST(Mp285Protocol, ReadsTheStatusOfARealOne) {
  const auto said = answer(Expected::kStatus, kRealStatus);
  ASSERT_TRUE(said && said->kind == Kind::kStatus);
  EXPECT_EQ(said->status.step_div, 25);
  EXPECT_EQ(said->status.step_mul, 4);
  EXPECT_FALSE(said->status.fine);
  EXPECT_EQ(said->status.speed, 200);
  EXPECT_EQ(said->status.bytes.substr(0, 8), "40 00 02");
  EXPECT_EQ(said->status.bytes.substr(said->status.bytes.size() - 5), "54 01");
}

TEST(Mp285Protocol, KnowsTheMicrostepOfTwoPairsOnly) {
  EXPECT_DOUBLE_EQ(*mp285Microstep(25, 4), 0.04e-6);
  EXPECT_DOUBLE_EQ(*mp285Microstep(400, 400), 0.04e-6);
  for (const auto& [step_div, step_mul] :
       {std::pair(25, 400), {400, 4}, {4, 25}, {0, 0}, {16, 4}, {25, 25}, {400, 0}, {100, 100}}) {
    EXPECT_FALSE(mp285Microstep(step_div, step_mul)) << step_div << ", " << step_mul;
  }
}

TEST(Mp285Protocol, RefusesWhatIsNoAnswer) {
  EXPECT_EQ(answer(Expected::kPosition, std::string(13, 'x'))->kind, Kind::kMalformed);
  EXPECT_EQ(answer(Expected::kPosition, std::string(7, 'x'), true)->kind, Kind::kMalformed);
  EXPECT_EQ(answer(Expected::kPosition, "\r", true)->kind, Kind::kMalformed);
  EXPECT_EQ(answer(Expected::kDone, "xy")->kind, Kind::kMalformed);
  for (const int byte : {0x10, 0x2f, 0x40, 0x61, 0xff}) {
    EXPECT_EQ(answer(Expected::kDone, bytes({byte, 0x0d}))->kind, Kind::kMalformed) << byte;
  }
  EXPECT_EQ(answer(Expected::kStatus, std::string(33, 'x'))->kind, Kind::kMalformed);
}

}  // namespace
}  // namespace microinjection
