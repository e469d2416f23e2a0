// The emulated MP-285 against what its clients send and show of a real one; its driver plays no part.

#include "hardware/devices/mp285/mp285_emulator.h"

#include <gtest/gtest.h>

#include "base/errors.h"
#include "hardware/devices/line_client.h"

namespace microinjection {
namespace {

/// Leaves a pause before what it sends.
struct Mp285Client : LineClient {
  explicit Mp285Client(std::shared_ptr<Mp285Emulator> emulator = std::make_shared<Mp285Emulator>())
      : LineClient(emulator, 9600), device(std::move(emulator)) {}
  std::shared_ptr<Mp285Emulator> device;
};

std::string move(int x) {
  std::string bytes = "m";
  for (const int each : {x, 0, 0}) {
    for (int i = 0; i < 4; ++i) bytes += static_cast<char>((each >> (8 * i)) & 0xff);
  }
  return bytes + "\r";
}

TEST(Mp285Emulator, TellsTheStatusOfARealOne) {
  const std::vector<int> real{64,  0,  2,  4,  7,  0, 99, 0, 99, 0, 20, 0, 136, 19, 1,  120,
                              112, 23, 16, 39, 80, 0, 0,  0, 25, 0, 4,  0, 200, 0,  84, 1};
  const std::string said = Mp285Client().answers("s\r");
  ASSERT_EQ(said.size(), 33u);
  for (std::size_t i = 0; i < real.size(); ++i) EXPECT_EQ(static_cast<unsigned char>(said[i]), real[i]) << i;
  EXPECT_EQ(said.back(), '\r');
}

TEST(Mp285Emulator, AnswersALineFeedByACarriageReturn) {
  Mp285Client client;
  EXPECT_EQ(client.answers("\n"), "\r");
  // Micro-Manager ends its commands with both, and expects two carriage returns; so does an error of it.
  EXPECT_EQ(client.answers("a\r\n"), "\r\r");
  client.device->inject(parseFault("error:4"));
  EXPECT_EQ(client.answers("a\r\n"), "4\r\r");
}

/// What acq4 sends (mp285.py) besides moves, and reads to the carriage return: it waits for ever for an answer that is
/// none. `R` and `p` are of an Arduino between acq4 and the device, which alone knows them; `r` is not answered.
TEST(Mp285Emulator, AnswersTheCommandsOfAcq4) {
  Mp285Client client;
  EXPECT_EQ(client.answers(std::string("V\x09\x83\r")), "\r");  // 777 um/s, fine, when it starts
  for (const char* command : {"a\r", "b\r", "e\r", "n\r", "o\r"}) EXPECT_EQ(client.answers(command), "\r") << command;
  EXPECT_EQ(client.answers(move(25)), "\r") << "still in relative mode";
  EXPECT_NEAR(client.device->position().x(), 1e-6, 1e-12);
  EXPECT_EQ(client.answers("r\r"), "");
  EXPECT_EQ(client.answers("c\r").size(), 13u);
  EXPECT_EQ(client.answers("\x03"), "\r");
}

TEST(Mp285Emulator, TellsErrorsAndTheirSumsAsCharacters) {
  Mp285Client client;
  EXPECT_EQ(client.answers("x"), "4\r");
  for (int code = 0; code < 8; ++code) {
    client.device->inject(parseFault("error:" + std::to_string(code)));
    EXPECT_EQ(client.answers("a\r"), std::string(1, static_cast<char>('0' + code)) + "\r");
  }
  client.device->inject(parseFault("error:12"));
  EXPECT_EQ(client.answers(move(250), 1), "<\r");
  for (const char* code : {"16", "-1", "x", "", "100"}) {
    EXPECT_THROW(client.device->inject(parseFault(std::string("error:") + code)), ConfigError) << code;
  }
}

TEST(Mp285Emulator, AnswersAStopAsItStoodOrMoved) {
  Mp285Client client;
  EXPECT_EQ(client.answers("\x03"), "\r");
  EXPECT_EQ(client.answers(move(25000)), "");  // 1 mm at 200 um/s
  EXPECT_EQ(client.answers("\x03"), "=\r");
}

TEST(Mp285Emulator, CountsFromZeroWhereItIsSwitchedOnWithTheSettingsOfDelivery) {
  Mp285Client client;
  const std::string delivered = client.answers("s\r");
  EXPECT_EQ(client.answers(std::string("V\x64\x80\r")), "\r");
  EXPECT_NE(client.answers("s\r"), delivered);
  EXPECT_EQ(client.answers(move(25000)), "");
  client.device->inject(parseFault("error:RESET"));
  EXPECT_EQ(client.answers("c\r"), std::string(12, '\0') + "\r");
  EXPECT_FALSE(client.device->moves());
  EXPECT_EQ(client.answers("s\r"), delivered);
}

TEST(Mp285Emulator, HearsNoCommandInThePauseAfterAnAnswer) {
  Mp285Client client;
  EXPECT_EQ(client.firstBytes("a\r"), "\r");
  EXPECT_EQ(client.answers("c\r", 0.2, 0), "");
  EXPECT_EQ(client.answers("c\r", 0.2, 3e-3).size(), 13u);
}

}  // namespace
}  // namespace microinjection
