#include "hardware/devices/sensapex/sensapex_protocol.h"

#include <gtest/gtest.h>

namespace microinjection {
namespace {

SensapexMessage positionMessage() {
  SensapexMessage message;
  message.receiver = SensapexMessage::kPc;
  message.sender = 1;
  message.number = 7;
  message.type = SensapexMessage::kGetPositions;
  message.blocks = {{1000, -1000, INT32_MAX}};
  return message;
}

TEST(SensapexProtocol, WritesMessagesWithTheHighByteFirst) {
  const std::string bytes = sensapexBytes(positionMessage());
  const unsigned char expected[] = {0x10, 0,    0x02, 0x9b, 0,    1,    0,    7,    0,    0,   0,
                                    0,    0,    14,   0,    1,    0,    6,    0,    3,    0,   0,
                                    0x03, 0xe8, 0xff, 0xff, 0xfc, 0x18, 0x7f, 0xff, 0xff, 0xff};
  EXPECT_EQ(bytes, std::string(reinterpret_cast<const char*>(expected), sizeof expected));
}

TEST(SensapexProtocol, ReadsMessagesHoweverTheirBytesAreGrouped) {
  const std::string bytes = sensapexBytes(positionMessage()) + sensapexBytes(positionMessage());
  for (std::size_t group = 1; group <= bytes.size(); ++group) {
    SensapexParser parser(1);
    std::vector<SensapexMessage> read;
    for (std::size_t at = 0; at < bytes.size(); at += group) {
      for (const SensapexMessage& each : parser.feed(bytes.substr(at, group), 0)) read.push_back(each);
    }
    ASSERT_EQ(read.size(), 2u) << group;
    EXPECT_EQ(read[1].blocks, positionMessage().blocks);
    EXPECT_EQ(read[1].number, 7);
    EXPECT_EQ(parser.malformed(), 0);
  }
}

TEST(SensapexProtocol, SkipsWhatIsNoMessageOfTheDevice) {
  SensapexMessage other = positionMessage(), foreign = positionMessage();
  other.sender = 2;
  foreign.receiver = 5;
  const std::string good = sensapexBytes(positionMessage());
  for (const std::string& bad : {sensapexBytes(other), sensapexBytes(foreign), std::string("hello"), good.substr(3),
                                 good.substr(0, 14) + std::string("\x7f\xff", 2)}) {
    SensapexParser parser(1);
    EXPECT_EQ(parser.feed(bad + good, 0).size(), 1u);
    EXPECT_EQ(parser.malformed(), 1);
  }
  SensapexParser parser(1);
  EXPECT_EQ(parser.feed(good.substr(0, 20), 0).size(), 0u);
  EXPECT_EQ(parser.feed("", 0.1).size(), 0u) << "the rest does not come any more";
  EXPECT_EQ(parser.malformed(), 1);
  EXPECT_EQ(parser.feed(good, 0.2).size(), 1u);
}

}  // namespace
}  // namespace microinjection
