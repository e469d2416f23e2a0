#include "hardware/devices/zaber/zaber_protocol.h"

#include <gtest/gtest.h>

namespace microinjection {
namespace {

TEST(ZaberProtocol, EncodesCommands) {
  EXPECT_EQ(zaberCommand({1, 2}, "move abs 10000", false), "/1 2 move abs 10000\n");
  EXPECT_EQ(zaberCommand({1, 2}, "get pos", false, 7), "/1 2 7 get pos\n");
  // '1' + ' ' + '0' + ' ' = 0x31 + 0x20 + 0x30 + 0x20 = 0xA1, and 0x100 - 0xA1 = 0x5F.
  EXPECT_EQ(zaberCommand({1, 0}, "", true), "/1 0 :5F\n");
}

std::vector<ZaberMessage> parse(const std::string& bytes, bool checksum = false) {
  return ZaberParser(checksum).feed(bytes);
}

TEST(ZaberProtocol, ReadsReplies) {
  const auto messages = parse("@01 0 OK IDLE -- 0\r\n@03 2 07 RJ BUSY WR BADDATA\r\n");
  ASSERT_EQ(messages.size(), 2u);
  EXPECT_EQ(messages[0].kind, ZaberMessage::Kind::kReply);
  EXPECT_TRUE(messages[0].from == (ZaberAddress{1, 0}));
  EXPECT_FALSE(messages[0].rejected || messages[0].busy || messages[0].number);
  EXPECT_EQ(messages[0].flag, "--");
  EXPECT_EQ(messages[0].position(), 0);
  EXPECT_TRUE(messages[1].from == (ZaberAddress{3, 2}));
  EXPECT_TRUE(messages[1].rejected && messages[1].busy);
  EXPECT_EQ(messages[1].number, 7);
  EXPECT_EQ(messages[1].flag, "WR");
  EXPECT_EQ(messages[1].data, "BADDATA");
  EXPECT_FALSE(messages[1].position());
}

TEST(ZaberProtocol, ReadsInfoAndAlerts) {
  const auto messages = parse("#01 0 hello there\r\n!01 1 IDLE FS\r\n");
  ASSERT_EQ(messages.size(), 2u);
  EXPECT_EQ(messages[0].kind, ZaberMessage::Kind::kInfo);
  EXPECT_EQ(messages[1].kind, ZaberMessage::Kind::kAlert);
  EXPECT_TRUE(isZaberFault(messages[1].flag));
  EXPECT_FALSE(isZaberFault("WR") || isZaberFault("--"));
}

TEST(ZaberProtocol, ComparesVersions) {
  for (const char* version : {"7.25", "7.26", "7.45", "8.0"}) EXPECT_EQ(zaberMovesHaveSpeeds(version), true) << version;
  for (const char* version : {"7.24", "7.05", "7.3", "6.28", "6.99"}) {
    EXPECT_EQ(zaberMovesHaveSpeeds(version), false) << version;
  }
  for (const char* none : {"", "7", "7.", ".25", "725", "7.x", "-7.25", "7.25.1", "7,25", "7.125"}) {
    EXPECT_EQ(zaberMovesHaveSpeeds(none), std::nullopt) << none;
  }
}

TEST(ZaberProtocol, PutsPiecesTogether) {
  ZaberParser parser(false);
  const std::string text = "noise\r\n@01 1 OK IDLE -- -12345\r\n";
  std::vector<ZaberMessage> messages;
  for (const char each : text) {
    for (const auto& message : parser.feed(std::string(1, each))) messages.push_back(message);
  }
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(messages[0].position(), -12345);
}

TEST(ZaberProtocol, ChecksChecksums) {
  std::string text = "01 1 OK IDLE -- 5";
  int sum = 0;
  for (const char each : text) sum += each;
  char digits[8];
  std::snprintf(digits, sizeof(digits), ":%02X", (0x100 - sum % 0x100) % 0x100);
  const std::string good = "@" + text + digits + "\r\n";
  EXPECT_EQ(parse(good).size(), 1u);
  EXPECT_EQ(parse(good, true).size(), 1u);
  std::string bad = good;
  bad[17] = '6';
  EXPECT_EQ(parse(bad).size(), 0u);
  EXPECT_EQ(parse("@" + text + "\r\n", true).size(), 0u);
}

TEST(ZaberProtocol, PassesOverWhatIsNoMessageAndIsInStepAgain) {
  for (const char* wrong :
       {"@01 1 OK IDLE --\r\n", "@01 1 OK IDLE - 5\r\n", "@01 1 NO IDLE -- 5\r\n", "@01 1 OK LAZY -- 5\r\n",
        "@0x 1 OK IDLE -- 5\r\n", "@001 1 OK IDLE -- 5\r\n", "@01 1 OK IDLE -- 5\n", "@01 1 OK ID\r\n", "@\r\n",
        "@@@\r\n", "@01 1 OK IDLE -- 5", "@01 -1 OK IDLE -- 5\r\n"}) {
    const auto messages = parse(std::string(wrong) + "@02 1 OK IDLE -- 7\r\n");
    ASSERT_EQ(messages.size(), 1u) << wrong;
    EXPECT_EQ(messages[0].from.device, 2);
  }
  EXPECT_TRUE(parse("@01 1 OK IDLE -- " + std::string(1000000, '5')).empty());
}

TEST(ZaberProtocol, BelievesNoImpossiblePosition) {
  for (const char* data :
       {"1e5", "5 6", "0x10", "2147483648", "-99999999999", "99999999999999999999", "--5", "5.0", "OK"}) {
    const auto messages = parse("@01 1 OK IDLE -- " + std::string(data) + "\r\n");
    ASSERT_EQ(messages.size(), 1u) << data;
    EXPECT_FALSE(messages[0].position()) << data;
  }
}

TEST(ZaberProtocol, ReadsListsOfWarnings) {
  const auto flags = [](const std::string& data) { return parse("@01 1 OK IDLE WT " + data + "\r\n").at(0).flags(); };
  EXPECT_EQ(flags("00"), std::vector<std::string>());
  EXPECT_EQ(flags("02 WT WR"), (std::vector<std::string>{"WT", "WR"}));
  for (const char* none : {"0", "01", "02 WT", "01 WT WR", "2 WT WR", "02 WT W", "02 WT wr", "01 --", "WT", "262467"}) {
    EXPECT_FALSE(flags(none)) << none;
  }
  EXPECT_TRUE(mayHideZaberReference("WT") && mayHideZaberReference("XY"));
  EXPECT_FALSE(mayHideZaberReference("--") || mayHideZaberReference("NI") || mayHideZaberReference("WR"));
}

}  // namespace
}  // namespace microinjection
