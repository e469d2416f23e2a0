// The emulated PatchMan against the command list of its manual; its driver plays no part.

#include "hardware/devices/eppendorf/eppendorf_emulator.h"

#include <gtest/gtest.h>

#include "hardware/devices/line_client.h"

namespace microinjection {
namespace {

struct EppendorfClient : LineClient {
  explicit EppendorfClient(const EppendorfEmulatorConfig& config = {})
      : EppendorfClient(std::make_shared<EppendorfEmulator>(config)) {}
  std::shared_ptr<EppendorfEmulator> device;

 private:
  explicit EppendorfClient(const std::shared_ptr<EppendorfEmulator>& emulator)
      : LineClient(emulator, 19200), device(emulator) {}
};

TEST(EppendorfEmulator, HearsEveryEndOfALineAndSaysACarriageReturn) {
  EppendorfClient client;
  EXPECT_EQ(client.answers("C001\r"), "A001 5181 V1.08\r");
  EXPECT_EQ(client.answers("C001\n"), "A001 5181 V1.08\r");
  EXPECT_EQ(client.answers("C001\r\n"), "A001 5181 V1.08\r");
}

TEST(EppendorfEmulator, MovesUnderRemoteControlOnly) {
  EppendorfClient client;
  EXPECT_EQ(client.answers("C010\r"), "A010 0 0 0 0\r");
  for (const char* command : {"C008\r", "C012 100 0 0 1000 0 0\r", "C007 100 0 0 1000 0 0\r"}) {
    EXPECT_EQ(client.answers(command).substr(0, 4), "ERR=") << command;
  }
  EXPECT_EQ(client.answers("C004\r"), "A004\r");
  EXPECT_EQ(client.answers("C012 100-200+300 1000 1000 1000\r", 1), "A012\r");
  EXPECT_EQ(client.answers("C010\r"), "A010 100 -200 300 0\r");
  EXPECT_EQ(client.answers("C005\r"), "A005\r");
  EXPECT_EQ(client.answers("C012 0 0 0 1000 1000 1000\r").substr(0, 4), "ERR=");
}

TEST(EppendorfEmulator, AnswersAGoToAtItsBeginOrAtItsEnd) {
  EppendorfClient client;
  client.answers("C004\r");
  EXPECT_EQ(client.answers("C012 1000 0 0 1000 0 0\r", 0.3), "A012\r");
  EXPECT_TRUE(client.device->moves());
  EXPECT_EQ(client.answers("C012 0 0 0 1000 0 0\r").substr(0, 4), "ERR=");
  EXPECT_EQ(client.answers("C013\r", 0.1), "");
  EXPECT_EQ(client.receive(1), "A013\r");
  EXPECT_EQ(client.answers("C007 0 500 0 1000 1000 0\r", 0.8), "");
  EXPECT_EQ(client.receive(1), "A007 0\r");
}

/// AutoInj_GUI, a public program on cells: line feeds, small letters, micrometres and microsteps.
TEST(EppendorfEmulator, AnswersWhatAutoInjGuiSends) {
  EppendorfClient client(TransfermanEmulatorConfig{});
  const std::pair<const char*, const char*> lines[] = {
      {"c010\n", "A010 0 0 0 0\r"},
      {"c009\n", "A009 0 0 0 0\r"},
      {"C004\n", "A004\r"},
      {"C007 -10 20 30 1000 1000 1000\n", "A007 0\r"},
      {"C009\n", "A009 -256 512 768 0\r"},
      {"C006 -128 512 -768 25600 25600 25600\n", "A006 0\r"},
      {"C009\n", "A009 -128 512 -768 0\r"},
      {"C010\n", "A010 -5 20 -30 0\r"},
      {"c005\n", "A005\r"},
  };
  for (const auto& [line, reply] : lines) EXPECT_EQ(client.answers(line, 0.5), reply) << line;
  EXPECT_NEAR(client.device->position().z(), -30e-6, 1e-12);
}

/// 2560 microsteps/s are 100 um/s, and the reply comes at the end.
TEST(EppendorfEmulator, AGoToInMicrostepsHasTheirSpeeds) {
  EppendorfClient client(TransfermanEmulatorConfig{});
  client.answers("C004\r");
  EXPECT_EQ(client.answers("C006 2560 0 0 2560 0 0\r", 0.5), "");
  EXPECT_NEAR(client.device->position().x(), 50e-6, 2.5e-6);
  EXPECT_EQ(client.receive(1), "A006 0\r");
}

TEST(EppendorfEmulator, AnAxisWithoutSpeedRests) {
  EppendorfClient client;
  client.answers("C004\r");
  client.answers("C012 100 100 100 1000 0 1000\r", 1);
  EXPECT_EQ(client.answers("C010\r"), "A010 100 0 100 0\r");
}

TEST(EppendorfEmulator, StopsAndTellsWhereItIs) {
  EppendorfClient client;
  client.answers("C004\r");
  client.answers("C012 1000 0 0 1000 0 0\r", 0.3);
  EXPECT_EQ(client.answers("C008\r"), "A008\r");
  EXPECT_FALSE(client.device->moves());
  const double x = client.device->position().x();
  EXPECT_GT(x, 0.2e-3);
  EXPECT_LT(x, 0.5e-3);
  EXPECT_EQ(client.answers("C010\r"), "A010 " + std::to_string(std::lround(x * 1e6)) + " 0 0 0\r");
}

TEST(EppendorfEmulator, StandsAtALimitSwitchAndTellsIt) {
  EppendorfEmulatorConfig config;
  config.travel = 1e-3;
  EppendorfClient client(config);
  client.answers("C004\r");
  EXPECT_EQ(client.answers("C007 -2000 2000 0 5000 5000 0\r", 1), "A007 9\r");
  EXPECT_EQ(client.answers("C010\r"), "A010 -1000 1000 0 9\r");
}

TEST(EppendorfEmulator, TellsPositionsInOtherForms) {
  EppendorfEmulatorConfig config;
  config.decimals = config.signs_separate = true;
  EppendorfClient client(config);
  client.answers("C004\r");
  client.answers("C012 100 -200 300 1000 1000 1000\r", 1);
  EXPECT_EQ(client.answers("C010\r"), "A010 100.00-200.00+300.00 0\r");
}

TEST(EppendorfEmulator, CountsFromZeroWhereItIsSwitchedOnAndIsNotUnderRemoteControl) {
  EppendorfClient client;
  client.answers("C004\r");
  client.answers("C012 1000 0 0 1000 0 0\r", 0.3);
  client.device->inject(parseFault("error:RESET"));
  EXPECT_EQ(client.answers("C010\r"), "A010 0 0 0 0\r");
  EXPECT_FALSE(client.device->moves());
  EXPECT_EQ(client.answers("C008\r").substr(0, 4), "ERR=");
}

TEST(EppendorfEmulator, RefusesWhatIsNoCommand) {
  EppendorfClient client;
  client.answers("C004\r");
  for (const char* command : {"C099\r", "C012 1 2 3\r", "C012 1 2 3 4 5 6 7\r", "C012 1,2,3,4,5,6\r", "C010 1\r", "x\r",
                              "C0101\r", "C012 1 2 3 4 5 6.5\r"}) {
    EXPECT_EQ(client.answers(command).substr(0, 4), "ERR=") << command;
  }
  EXPECT_EQ(client.device->movesBegun(), 0);
}

}  // namespace
}  // namespace microinjection
