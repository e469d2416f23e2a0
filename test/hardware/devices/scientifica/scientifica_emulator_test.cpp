// The emulated PatchStar against what its clients send and note; its driver plays no part.

#include "hardware/devices/scientifica/scientifica_emulator.h"

#include <gtest/gtest.h>

#include "hardware/devices/line_client.h"

namespace microinjection {
namespace {

struct ScientificaClient : LineClient {
  explicit ScientificaClient(const std::string& version = "3.12")
      : ScientificaClient(makeDevice(version), version < "3" ? 9600 : 38400) {}
  std::shared_ptr<ScientificaEmulator> device;

 private:
  ScientificaClient(const std::shared_ptr<ScientificaEmulator>& emulator, double baud)
      : LineClient(emulator, baud), device(emulator) {}
  static std::shared_ptr<ScientificaEmulator> makeDevice(const std::string& version) {
    ScientificaEmulatorConfig config;
    config.version = version;
    return std::make_shared<ScientificaEmulator>(config);
  }
};

void expectPosition(ScientificaClient& client, const Eigen::Vector3d& position) {
  EXPECT_LT((client.device->position() - position).norm(), 0.02e-6) << client.device->position().transpose();
}

/// What acq4 asks when it connects.
TEST(ScientificaEmulator, TellsWhatItIsInTheUnitsOfItsVersion) {
  ScientificaClient old("2.13"), card("3.12");
  EXPECT_EQ(card.answers("scientifica\r"), "Y519\r");
  EXPECT_EQ(card.answers("ver\r"), "3.12\r");
  EXPECT_EQ(card.answers("type\r"), "3.05\r");
  EXPECT_EQ(card.answers("USTEP X\r"), "1600.00\r");
  EXPECT_EQ(card.answers("UUX\r"), "E,3\r");
  EXPECT_EQ(old.answers("ver\r"), "2.13\r");
  EXPECT_EQ(old.answers("UUX\r"), "-6.40\r");
  EXPECT_EQ(old.answers("TOP\r"), "30000\r");
  EXPECT_EQ(old.answers("ACC\r"), "500\r");
  EXPECT_EQ(old.answers("TOP 999\r"), "E\r");
  EXPECT_EQ(old.answers("TOP 1000\r"), "A\r");
  EXPECT_EQ(old.answers("TOP\r"), "1000\r");
}

TEST(ScientificaEmulator, MovesAndTellsItsMotion) {
  for (const char* version : {"2.13", "3.12"}) {
    ScientificaClient client(version);
    const int per_um = version[0] == '2' ? 10 : 100;
    EXPECT_EQ(client.answers("S\r"), "0\r");
    EXPECT_EQ(client.answers("ABS " + std::to_string(1000 * per_um) + " 0 0\r"), "A\r");
    EXPECT_NE(client.answers("s\r", 0.05), "0\r");
    EXPECT_EQ(client.answers("ABS 0 0 0\r"), "");  // acq4: it is not answered
    client.receive(2);
    EXPECT_EQ(client.answers("S\r"), "0\r");
    EXPECT_EQ(client.answers("P\r"), std::to_string(1000 * per_um) + "\t0\t0\r");
    EXPECT_EQ(client.answers("POS\r"), std::to_string(1000 * per_um) + "\t0\t0\r");
    EXPECT_NEAR(client.device->position().x(), 1e-3, 1e-9);
  }
}

/// Micro-Manager's stage moves x and y.
TEST(ScientificaEmulator, TwoNumbersMoveTwoAxes) {
  ScientificaClient client("2.13");
  EXPECT_EQ(client.answers("ABS 1000 2000 3000\r", 2), "A\r");
  EXPECT_EQ(client.answers("abs 500 600\r", 2), "A\r");
  EXPECT_EQ(client.answers("POS\r"), "500\t600\t3000\r");
  EXPECT_EQ(client.answers("rel 10 0 -10\r", 2), "A\r");
  EXPECT_EQ(client.answers("POS\r"), "510\t600\t2990\r");
}

/// What acq4 and Micro-Manager send (and a patch-clamp program's driver), in their letters, in turn.
TEST(ScientificaEmulator, AnswersWhatOtherProgramsSend) {
  ScientificaClient client("2.13");
  const std::pair<const char*, const char*> lines[] = {
      // acq4: it connects, asks for the speed, moves, sets the speed back, zeroes an axis.
      {"scientifica\r", "Y519\r"},
      {"ver\r", "2.13\r"},
      {"UUX\r", "-6.40\r"},
      {"type\r", "1.05\r"},
      {"desc\r", "PatchStar\r"},
      {"desc left pipette\r", "A\r"},
      {"desc\r", "left pipette\r"},
      {"TOP\r", "30000\r"},
      {"TOP 12800.000000\r", "A\r"},
      {"TOP\r", "12800\r"},
      {"FIRST 1000.000000\r", "A\r"},
      {"ACC 500.000000\r", "A\r"},
      {"TOP 500.000000\r", "E\r"},  // 39 um/s: below what a version 2 card takes
      {"JSPEED 20.000000\r", "A\r"},
      {"JDX ?\r", "0\r"},
      {"JDX 1\r", "A\r"},
      {"JDX ?\r", "1\r"},
      {"ANGLE 30.000000\r", "A\r"},
      {"limits\r", "0\r"},
      {"POS\r", "0\t0\t0\r"},
      {"PY 0\r", "A\r"},
      {"S\r", "0\r"},
      {"CURRENT\r", "230 175\r"},
      // Micro-Manager: it asks for one axis at a time, moves x and y or z, sets an origin.
      {"PX\r", "0\r"},
      {"abs 100 -200\r", "A\r"},
      {"PX\r", "100\r"},
      {"PY\r", "-200\r"},
      {"absz 300\r", "A\r"},
      {"PZ\r", "300\r"},
      {"s\r", "0\r"},
      {"pz 0 \r", "A\r"},
      {"PZ\r", "0\r"},
      {"px = 0\r", "A\r"},
      {"PX\r", "0\r"},
      {"POS\r", "0\t-200\t0\r"},
      {"TOP 30000\r", "A\r"},
      {"rel 5 5\r", "A\r"},
  };
  for (const auto& [line, reply] : lines) EXPECT_EQ(client.answers(line, 1), reply) << line;
  ScientificaClient card("3.12");
  EXPECT_EQ(card.answers("TOP 500.000000\r"), "A\r");
  EXPECT_EQ(card.answers("TOP\r"), "500\r");
  for (const char* line : {"TOP nan\r", "TOP 1e9\r", "TOP -1.0\r"}) EXPECT_EQ(card.answers(line)[0], 'E') << line;
}

/// Micro-Manager's stage goes home to its corner.
TEST(ScientificaEmulator, GoesToItsLimitsByVelocities) {
  ScientificaClient client("2.13");
  EXPECT_EQ(client.answers("vj 30000 30000 0\r", 10), "A\r");
  EXPECT_FALSE(client.device->moves());
  expectPosition(client, {10e-3, 10e-3, 0});
  for (const char* wrong : {"vj\r", "vj 1 2\r", "vj 1 2 x\r"}) EXPECT_EQ(client.answers(wrong), "E,3\r") << wrong;
}

/// acq4 sets its default speed again as soon as a move has begun.
TEST(ScientificaEmulator, ASpeedThatIsSetDuringAMoveIsOfTheNext) {
  ScientificaClient client("2.13");
  client.answers("TOP 12800.000000\r");
  client.answers("ABS 20000 0 0\r", 0.2);
  client.answers("TOP 1000.000000\r", 0.3);
  const double before = client.device->position().x();
  client.receive(0.5);
  EXPECT_NEAR((client.device->position().x() - before) / 0.5, 1e-3, 0.01e-3);
}

/// TOP 12800 of a version 2 card is 1 mm/s, ACC 500 is 19.5 mm/s^2.
TEST(ScientificaEmulator, MovesAtItsSpeedWithItsRamps) {
  ScientificaClient client("2.13");
  client.answers("TOP 12800\r");
  client.answers("FIRST 1000\r");
  client.answers("ABS 20000 0 0\r", 0);
  client.receive(1);
  const double before = client.device->position().x();
  client.receive(0.5);
  EXPECT_NEAR((client.device->position().x() - before) / 0.5, 1e-3, 0.01e-3);
  const double told = client.device->position().x(), wire = 5 * 10.0 / 9600;  // s
  EXPECT_EQ(client.answers("STOP\r", 1, 0), "A\r");
  EXPECT_FALSE(client.device->moves());
  EXPECT_NEAR(client.device->position().x() - told, 1e-3 * wire + 1e-6 / (2 * 0.0195), 2e-6);
}

TEST(ScientificaEmulator, CountsFromZeroWhereItIsSwitchedOnWithTheSettingsOfDelivery) {
  ScientificaClient client("2.13");
  for (const char* command : {"TOP 12800\r", "FIRST 1000\r", "ACC 700\r", "ABS 20000 0 0\r"}) {
    EXPECT_EQ(client.answers(command), "A\r");
  }
  client.device->inject(parseFault("error:RESET"));
  EXPECT_EQ(client.answers("S\r"), "0\r");
  EXPECT_EQ(client.answers("POS\r"), "0\t0\t0\r");
  EXPECT_EQ(client.answers("TOP\r"), "30000\r");
  EXPECT_EQ(client.answers("FIRST\r"), "5000\r");
  EXPECT_EQ(client.answers("ACC\r"), "500\r");
}

TEST(ScientificaEmulator, RefusesWhatIsNoCommand) {
  ScientificaClient client;
  for (const char* command :
       {"APPROACH\r", "ABS\r", "ABS 1\r", "ABS 1 2 x\r", "ABS 1 2 3 4\r", "ABS 1.5 2 3\r", "FOO 1\r"}) {
    EXPECT_EQ(client.answers(command), "E,3\r") << command;
  }
  EXPECT_EQ(client.answers("\r"), "");
  EXPECT_EQ(client.device->movesBegun(), 0);
}

}  // namespace
}  // namespace microinjection
