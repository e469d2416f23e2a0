#include "hardware/devices/eppendorf/eppendorf_protocol.h"

#include <gtest/gtest.h>

namespace microinjection {
namespace {

TEST(EppendorfProtocol, SaysCommandsAsTheManualPrintsThem) {
  EXPECT_EQ(eppendorfRemote(), "C004");
  EXPECT_EQ(eppendorfManual(), "C005");
  EXPECT_EQ(eppendorfStop(), "C008");
  EXPECT_EQ(eppendorfPosition(), "C010");
  EXPECT_EQ(eppendorfGoTo({100, -200, 300}, {1000, 0, 7500}), "C012 100 -200 300 1000 0 7500");
}

TEST(EppendorfProtocol, KnowsTheAnswerToACommand) {
  EXPECT_TRUE(isEppendorfReply("A004", eppendorfRemote()));
  EXPECT_TRUE(isEppendorfReply("A012", eppendorfGoTo({1, 2, 3}, {4, 5, 6})));
  for (const char* answer : {"A005", "A0040", "A004 ", "a004", "C004", ""}) {
    EXPECT_FALSE(isEppendorfReply(answer, eppendorfRemote())) << answer;
  }
}

TEST(EppendorfProtocol, ReadsPositionsSeparatedBySpacesOrSigns) {
  for (const char* answer : {"A010 100 -200 300 0", "A010 100-200+300 0", "A010 +100 -200 +300 0", "A010+100-200+300 0",
                             "A010  100  -200  300  0", "A010 100.0 -200.00 300.000 0"}) {
    const auto position = readEppendorfPosition(answer);
    ASSERT_TRUE(position) << answer;
    EXPECT_EQ(position->coordinates, Eigen::Vector3d(100, -200, 300)) << answer;
    EXPECT_EQ(position->limits, 0);
  }
  EXPECT_EQ(readEppendorfPosition("A010 1 2 3 34")->limits, 34);
  EXPECT_EQ(readEppendorfPosition("A010 -0.25 2 3 0")->coordinates.x(), -0.25);
}

TEST(EppendorfProtocol, RefusesWhatIsNoPosition) {
  for (const char* answer : {"", "A010", "A010 100 -200 300", "A010 100 -200 300 0 0", "A009 100 -200 300 0",
                             "A010 100,-200,300,0", "A010 1e2 -200 300 0", "A010 100 - 200 300 0", "A010100 -200 300 0",
                             "A010 1234567890 0 0 0", "A010 100 200 nan 0", " A010 100 -200 300 0",
                             "A010 100 -200 300 0 ", "A010 100 -200 300. 0", "A010 100 -200 .5 0"}) {
    EXPECT_FALSE(readEppendorfPosition(answer)) << answer;
  }
}

TEST(EppendorfProtocol, KnowsMicrosteps) {
  EXPECT_EQ(eppendorfPosition(EppendorfUnit::kMicrostep), "C009");
  EXPECT_EQ(eppendorfGoToMicrosteps({-256, 0, 512}, {25, 26, 27}), "C006 -256 0 512 25 26 27\rC009");
  EXPECT_EQ(readEppendorfPosition("A009 -256 0 512 0", EppendorfUnit::kMicrostep)->coordinates,
            Eigen::Vector3d(-256, 0, 512));
  EXPECT_FALSE(readEppendorfPosition("A009 -256 0 512 0"));
  EXPECT_FALSE(readEppendorfPosition("A010 -256 0 512 0", EppendorfUnit::kMicrostep));
  for (const char* end : {"A006 0\r", "A006 63\r", "\nA006 0\r"}) EXPECT_TRUE(isEppendorfMoveEnd(end)) << end;
  for (const char* other : {"A006\r", "A006 0", "A007 0\r", "xA006 0\r", "A006 12345\r"}) {
    EXPECT_FALSE(isEppendorfMoveEnd(other)) << other;
  }
  for (const char* begins : {"", "A", "A0", "A00", "A006", "A006 ", "A006 6", "\nA006 63"}) {
    EXPECT_TRUE(mayBeEppendorfMoveEnd(begins)) << begins;
  }
  for (const char* other : {"A009", "A01", "E", "A006 x", "A006 12345"}) {
    EXPECT_FALSE(mayBeEppendorfMoveEnd(other)) << other;
  }
}

}  // namespace
}  // namespace microinjection
