// The emulators against what manuals and public clients show, without any driver of ours.

#include <gtest/gtest.h>

#include <map>
#include <sstream>

#include "base/errors.h"
#include "hardware/injector/arduino_emulator.h"
#include "hardware/injector/femtojet_emulator.h"
#include "hardware/injector/output_module_emulator.h"

namespace microinjection {
namespace {

std::string talk(DeviceEmulator& device, const std::string& bytes, double& time) {
  device.receive(bytes, time += 0.1);
  return device.send(time += 0.1);
}

/// The public program reads two lines after each command, and takes the second word of the second one for the number.
double secondWord(const std::string& lines) {
  std::istringstream in(lines);
  std::string line, word;
  std::getline(in, line);
  std::getline(in, line);
  std::istringstream words(line);
  double number = -1;
  words >> word >> number;
  return number;
}

TEST(FemtojetEmulator, AnswersThePublicProgram) {
  FemtojetEmulator device;
  double time = 0;
  EXPECT_EQ(talk(device, "AB\n", time), "AB\r\nERR=001\r\n");
  EXPECT_EQ(talk(device, "C042=2\n", time), "C042=2\r\nA042\r\n");
  EXPECT_EQ(talk(device, "C043=25\n", time), "C043=25\r\nA043\r\n");
  EXPECT_EQ(talk(device, "C044=100\n", time), "C044=100\r\nA044\r\n");
  EXPECT_EQ(secondWord(talk(device, "C152\n", time)), 2);
  EXPECT_EQ(secondWord(talk(device, "C153\n", time)), 25);
  EXPECT_EQ(secondWord(talk(device, "C154\n", time)), 100);
  EXPECT_NEAR(device.pressure(), 2500, 1e-9);
  EXPECT_EQ(talk(device, "C013=0.5\n", time), "C013=0.5\r\nA013\r\n") << "it cleans";
  EXPECT_NEAR(device.pressure(), 600e3, 1e-9);
  device.send(time + 0.6);
  EXPECT_NEAR(device.pressure(), 2500, 1e-9);
}

TEST(FemtojetEmulator, TakesTheFormsThatTheManualAllows) {
  FemtojetEmulatorConfig config;
  config.echo = FemtojetEmulatorConfig::Echo::kNone;
  FemtojetEmulator device(config);
  double time = 0;
  EXPECT_EQ(talk(device, "c042=0.5\r", time), "A042\r\n") << "small letters, a carriage return";
  EXPECT_EQ(talk(device, "C152\r\n", time), "A152=       0.5\r\n") << "ten characters";
  for (const char* faulty :
       {"C42=1\r", "C042=x\r", "C042=100\r", "C044=6001\r", "C999\r", "HELLO\r", "C042=12345678901\r"}) {
    EXPECT_EQ(talk(device, faulty, time), "ERR=001\r\n") << faulty;
  }
  config.echo = FemtojetEmulatorConfig::Echo::kEmptyLine;
  FemtojetEmulator other(config);
  EXPECT_EQ(talk(other, "C042=1\n", time), "\r\nA042\r\n");
}

TEST(FemtojetEmulator, InjectsForItsTimeAndNotTwiceAtOnce) {
  FemtojetEmulatorConfig config;
  config.echo = FemtojetEmulatorConfig::Echo::kNone;
  FemtojetEmulator device(config);
  double time = 0;
  EXPECT_EQ(talk(device, "C901\n", time), "A901\r\n");  // at 0.1 s, for 2 s
  EXPECT_NEAR(device.pressure(), 10e3, 1e-9);
  EXPECT_EQ(talk(device, "C901\n", time), "ERR=001\r\n");
  device.send(2.05);
  EXPECT_NEAR(device.pressure(), 10e3, 1e-9);
  device.send(2.15);
  EXPECT_NEAR(device.pressure(), 2500, 1e-9);
  time = 3;
  device.inject({Fault::Kind::kError, 0, "012", 0});
  EXPECT_EQ(talk(device, "C901\n", time), "ERR=012\r\n");
  EXPECT_NEAR(device.pressure(), 2500, 1e-9);
  EXPECT_THROW(device.inject({Fault::Kind::kError, 0, "12", 0}), ConfigError);
}

/// Its client sends "bc", a number from 0 to 255 and "C", or "x", and prints what comes.
TEST(ArduinoEmulator, DoesWhatItsFirmwareDoes) {
  ArduinoEmulator device;
  const auto hears = [&](const std::string& command, double time) {
    device.receive(command, time);
    return device.send(time + 0.03 * double(command.size()) + 1e-3);
  };
  EXPECT_EQ(hears("bc100C", 1), "Arduino recieved: bc100C\r\n");
  EXPECT_NEAR(device.pressure(), 20e3, 1e-9);
  EXPECT_EQ(hears("bc255Cpressure!100!", 2), "Arduino recieved: bc255Cpressure!100!\r\n") << "Autoinjector 1.0's";
  EXPECT_NEAR(device.pressure(), 51e3, 1e-9);
  double time = 2;
  for (const auto& [command, steps] : std::map<std::string, int>{{"bc256C", 0}, {"bc7C", 7}, {"bc7", 7}, {"bC9c", 0}}) {
    hears(command, ++time);
    EXPECT_NEAR(device.pressure(), 200 * steps, 1e-9) << command;
  }
  EXPECT_EQ(hears("bc0C", ++time), "Arduino recieved: bc0C\r\n");
  EXPECT_EQ(hears("c100C", ++time), "Arduino recieved: c100C\r\n") << "repeated, and no command";
  EXPECT_NEAR(device.pressure(), 0, 1e-9);
}

TEST(ArduinoEmulator, IsSlow) {
  ArduinoEmulator device;
  device.receive("bc100C", 1);
  EXPECT_EQ(device.send(1.17), "");
  device.receive("bc003C", 1.175);
  EXPECT_EQ(device.send(1.35), "");
  EXPECT_EQ(device.send(1.37), "Arduino recieved: bc100Cbc003C\r\n") << "what comes too early belongs to the first";
  EXPECT_NEAR(device.pressure(), 20e3, 1e-9);
  device.receive("bc003C", 1.4);
  EXPECT_EQ(device.send(1.63), "") << "0.1 s after a command it listens again";
  EXPECT_EQ(device.send(1.65), "Arduino recieved: bc003C\r\n");
  device.receive("x", 2);
  for (const auto& [time, pressure] :
       std::map<double, double>{{2.1, 0}, {2.3, 100e3}, {2.7, 100e3}, {2.8, 0}, {3.2, 600}}) {
    device.send(time);
    EXPECT_NEAR(device.pressure(), pressure, 1e-9) << time;
  }
  device.inject({Fault::Kind::kInterrupt, 0, "", 4});
  device.receive("bc100C", 4.1);
  EXPECT_EQ(device.send(6), "") << "its boot loader does not hear";
  EXPECT_NEAR(device.pressure(), 0, 1e-9);
  EXPECT_THROW(device.inject({Fault::Kind::kError, 0, "1", 0}), ConfigError);
}

TEST(OutputModuleEmulator, RelaysAnswerAsTheManualsExamples) {
  OutputModuleConfig config;
  config.address = "14";
  OutputModuleEmulator device(config);
  double time = 0;
  EXPECT_EQ(talk(device, "#140005\r", time), ">\r");
  EXPECT_EQ(talk(device, "$146\r", time), "!050000\r");
  EXPECT_NEAR(device.pressure(), config.supply, 1e-9);
  EXPECT_EQ(talk(device, "#141000\r", time), ">\r");
  EXPECT_EQ(talk(device, "#141201\r", time), ">\r");
  EXPECT_EQ(talk(device, "$146\r", time), "!040000\r");
  EXPECT_NEAR(device.pressure(), config.balance, 1e-9);
  EXPECT_EQ(talk(device, "#151201\r", time), "") << "another address";
  EXPECT_EQ(talk(device, "141201\r", time), "") << "no delimiter";
  for (const char* invalid : {"#141401\r", "#141002\r", "#1410\r", "#14+05.000\r", "$149\r"}) {
    EXPECT_EQ(talk(device, invalid, time), "?14\r") << invalid;
  }
  EXPECT_EQ(talk(device, "$146\n", time), "") << "a line ends with a carriage return";
}

TEST(OutputModuleEmulator, AVoltageIsReadBackAsItWasSent) {
  OutputModuleConfig config;
  config.kind = OutputModuleConfig::Kind::kVoltage;
  config.address = "0A";
  OutputModuleEmulator device(config);
  double time = 0;
  EXPECT_EQ(talk(device, "$0A6\r", time), "!0A00.000\r");
  EXPECT_EQ(talk(device, "#0A03.000\r", time), ">\r");
  EXPECT_EQ(talk(device, "$0A6\r", time), "!0A03.000\r");
  EXPECT_NEAR(device.pressure(), 15e3, 1e-6);
  for (const char* invalid : {"#0A10.001\r", "#0A3.000\r", "#0A-1.000\r"}) {
    EXPECT_EQ(talk(device, invalid, time), "?0A\r") << invalid;
  }
  device.inject({Fault::Kind::kInterrupt, 0, "", 0});
  EXPECT_EQ(talk(device, "$0A6\r", time), "!0A00.000\r");
}

}  // namespace
}  // namespace microinjection
