// The emulated devices against the manuals and what public clients show of real ones (doc/reference/devices.md).

#include "hardware/devices/zaber/zaber_emulator.h"

#include <gtest/gtest.h>

#include "base/errors.h"
#include "hardware/devices/zaber/with_firmware.h"

namespace microinjection {
namespace {

ZaberEmulatorConfig chain() {
  ZaberEmulatorConfig config;
  config.devices = {1, 2, 3};
  config.axes = {1, 1, 1};
  return config;
}

/// What a device says to one command, 10 ms later.
std::string answer(ZaberEmulator& device, const std::string& command, double& time) {
  device.receive("/" + command + "\n", time);
  return device.send(time += 0.01);
}

TEST(ZaberEmulator, TakesSpeedsOfMovesFromTheFirmwareOnThatHasThem) {
  for (const char* command : {"move abs 1000 500", "move rel 10 500 7", "move vel 10 7"}) {
    double time = 0;
    ZaberEmulator old(withFirmware("7.24")), recent(withFirmware("7.25"));
    EXPECT_EQ(answer(old, std::string("1 1 ") + command, time), "@01 1 RJ IDLE -- BADDATA\r\n");
    EXPECT_EQ(answer(recent, std::string("1 1 ") + command, time), "@01 1 OK BUSY -- 0\r\n");
    EXPECT_EQ(answer(recent, std::string("1 1 ") + command + " 9 9", time), "@01 1 RJ BUSY -- BADDATA\r\n");
  }
}

TEST(ZaberEmulator, MovesAtTheSpeedThatItIsTold) {
  ZaberEmulator device;
  double time = 0;
  answer(device, "1 1 move rel 100000 16384", time);  // 10,000 microsteps/s
  answer(device, "1 1 get pos", time = 0.5);
  const double from = device.position().x();
  answer(device, "1 1 get pos", time = 1.5);
  EXPECT_NEAR((device.position().x() - from) / 0.047625e-6, 1e4, 150);  // the 10 ms of two answers
}

TEST(ZaberEmulator, TellsItsVersionOnceForADevice) {
  double time = 0;
  ZaberEmulator one(withFirmware("6.28"));
  EXPECT_EQ(answer(one, "1 0 get version", time), "@01 0 OK IDLE -- 6.28\r\n");
  ZaberEmulatorConfig config;
  config.devices = {1, 2, 3};
  config.axes = {1, 1, 1};
  ZaberEmulator three(config);
  EXPECT_EQ(answer(three, "2 0 get version", time), "@02 0 OK IDLE -- 7.25\r\n");
  for (const char* none : {"", "7", "7.x", "5.1", "8.0", "7.25 ", "-7.25"}) {
    EXPECT_THROW(one.setFirmware(none), ConfigError) << none;
  }
}

/// A device, and what it says to one command after another.
class Device {
 public:
  explicit Device(const ZaberEmulatorConfig& config = {}) : device_(config) {}
  std::string operator()(const std::string& command) { return answer(device_, command, time_); }
  std::string wait(double duration) { return device_.send(time_ += duration); }
  void raise(const std::string& code) { device_.inject(parseFault("error:" + code)); }
  Eigen::Vector3d place() const { return device_.position() / 0.047625e-6; }  // microsteps

 private:
  ZaberEmulator device_;
  double time_ = 0;  // s
};

TEST(ZaberEmulator, AnswersOnceADeviceWithTheDataOfAllAxes) {
  Device one;
  EXPECT_EQ(one("1 0 get pos"), "@01 0 OK IDLE -- 262467 262467 262467\r\n");
  EXPECT_EQ(one("1 2 get pos"), "@01 2 OK IDLE -- 262467\r\n");
  EXPECT_EQ(one("1 0 stop"), "@01 0 OK IDLE -- 0\r\n");
  EXPECT_EQ(one(""), "@01 0 OK IDLE -- 0\r\n");
  EXPECT_EQ(one("1 3 move vel 5000"), "@01 3 OK BUSY -- 0\r\n");
  EXPECT_EQ(one("1 0"), "@01 0 OK BUSY -- 0\r\n");  // one of them moves
  EXPECT_EQ(one("1 1"), "@01 1 OK IDLE -- 0\r\n");
  Device three(chain());
  EXPECT_EQ(three("0 0 get comm.address"), "@01 0 OK IDLE -- 1\r\n@02 0 OK IDLE -- 2\r\n@03 0 OK IDLE -- 3\r\n");
  EXPECT_EQ(three("2 0 get pos"), "@02 0 OK IDLE -- 262467\r\n");
  EXPECT_EQ(three("4 0 get pos"), "");
}

/// Device, axis and message ID may be left out, from the end on: public clients send "/home", "/get pos", "/1 get pos".
TEST(ZaberEmulator, UnderstandsShortAddresses) {
  Device one, three(chain());
  EXPECT_EQ(one("get pos"), "@01 0 OK IDLE -- 262467 262467 262467\r\n");
  EXPECT_EQ(one("1 get pos"), "@01 0 OK IDLE -- 262467 262467 262467\r\n");
  EXPECT_EQ(one("1 2 7 get pos"), "@01 2 07 OK IDLE -- 262467\r\n");
  EXPECT_EQ(one("1"), "@01 0 OK IDLE -- 0\r\n");
  EXPECT_EQ(one("1 set comm.alert 0"), "@01 0 OK IDLE -- 0\r\n");
  EXPECT_EQ(one("get device.id"), "@01 0 OK IDLE -- 50000\r\n");
  EXPECT_EQ(three("2 get pos"), "@02 0 OK IDLE -- 262467\r\n");
  EXPECT_EQ(three("get pos"), "@01 0 OK IDLE -- 262467\r\n@02 0 OK IDLE -- 262467\r\n@03 0 OK IDLE -- 262467\r\n");
  EXPECT_EQ(three("1 move abs 5000"), "@01 0 OK BUSY -- 0\r\n");
  EXPECT_EQ(one("home"), "@01 0 OK BUSY -- 0\r\n");
  one.wait(10);
  EXPECT_NEAR(one.place().norm(), 0, 0.1);
  EXPECT_EQ(one("nonsense"), "@01 0 RJ IDLE -- BADCOMMAND\r\n");
  EXPECT_EQ(one("x 1 get pos"), "@01 0 RJ IDLE -- BADCOMMAND\r\n");
}

TEST(ZaberEmulator, AMessageIdOfTwoDashesAsksForNoReply) {
  Device one;
  EXPECT_EQ(one("1 1 -- move rel 5000"), "");
  one.wait(1);
  EXPECT_EQ(one("1 1 get pos"), "@01 1 OK IDLE -- 267467\r\n");
}

TEST(ZaberEmulator, TellsTheSettingsThatClientsAskFor) {
  Device one;
  EXPECT_EQ(one("1 1 get accel"), "@01 1 OK IDLE -- 688\r\n");        // 0.2 m/s^2
  EXPECT_EQ(one("1 1 get maxspeed"), "@01 1 OK IDLE -- 172010\r\n");  // 5 mm/s
  EXPECT_EQ(one("1 0 get resolution"), "@01 0 OK IDLE -- 64 64 64\r\n");
  for (const auto& [name, value] : {std::pair("system.access", "1"),
                                    {"comm.address", "1"},
                                    {"comm.alert", "0"},
                                    {"comm.checksum", "0"},
                                    {"comm.protocol", "2"},
                                    {"system.axiscount", "3"}}) {
    EXPECT_EQ(one(std::string("1 0 get ") + name), std::string("@01 0 OK IDLE -- ") + value + "\r\n");
    EXPECT_EQ(one(std::string("1 1 get ") + name), "@01 1 RJ IDLE -- DEVICEONLY\r\n");
  }
  EXPECT_EQ(one("1 1 get nonsense"), "@01 1 RJ IDLE -- BADCOMMAND\r\n");
  EXPECT_EQ(one("1 2 set motion.decelonly 300"), "@01 2 OK IDLE -- 0\r\n");
  EXPECT_EQ(one("1 0 get motion.decelonly"), "@01 0 OK IDLE -- 688 300 688\r\n");
}

TEST(ZaberEmulator, RefusesWhatIsOutOfRange) {
  Device one;
  EXPECT_EQ(one("1 4 get pos"), "@01 0 RJ IDLE -- BADAXIS\r\n");
  for (const char* command :
       {"move vel 1048577", "move vel -1048577", "move abs 524935", "move abs -1", "move rel 300000",
        "move abs 5 1048577", "move abs x", "set maxspeed 1048577", "set accel -1"}) {
    EXPECT_EQ(one(std::string("1 1 ") + command), "@01 1 RJ IDLE -- BADDATA\r\n") << command;
  }
  EXPECT_EQ(one("1 1 move vel 1048576"), "@01 1 OK BUSY -- 0\r\n");
  EXPECT_EQ(one("1 0 set system.access 3"), "@01 0 RJ BUSY -- BADDATA\r\n");
}

TEST(ZaberEmulator, ShowsTheMostImportantFlagAndListsAll) {
  Device one;
  one.raise("WT");
  one.raise("NC");
  EXPECT_EQ(one("1 1 warnings"), "@01 1 OK IDLE WT 02 WT NC\r\n");
  one.raise("WR");
  EXPECT_EQ(one("1 1 get pos"), "@01 1 OK IDLE WT 262467\r\n");
  one.raise("FS");
  EXPECT_EQ(one("1 0 warnings"), "@01 0 OK IDLE FS 04 FS WT WR NC\r\n");
  EXPECT_EQ(one("1 1 warnings clear"), "@01 1 OK IDLE WR 04 FS WT WR NC\r\n");
  EXPECT_EQ(one("1 1 warnings"), "@01 1 OK IDLE WR 01 WR\r\n");  // only a reference position ends that
  EXPECT_EQ(one("1 1 move abs 1000"), "@01 1 RJ IDLE WR BADDATA\r\n");
  EXPECT_EQ(one("1 1 set pos 262467"), "@01 1 OK IDLE -- 0\r\n");
}

TEST(ZaberEmulator, WhatIsInterruptedIsNoted) {
  Device one;
  EXPECT_EQ(one("1 1 move abs 300000"), "@01 1 OK BUSY -- 0\r\n");
  EXPECT_EQ(one("1 1 move abs 310000"), "@01 1 OK BUSY NI 0\r\n");
  one("1 1 stop");
  one.wait(1);
  EXPECT_EQ(one("1 1 warnings"), "@01 1 OK IDLE NI 01 NI\r\n");
  EXPECT_EQ(one("1 1 warnings clear"), "@01 1 OK IDLE -- 01 NI\r\n");
}

TEST(ZaberEmulator, SendsAlertsAndInfoLinesAndChecksumsWhereTheyAreSet) {
  Device one;
  one("1 0 set comm.alert 1");
  one("1 2 move rel 10000");
  EXPECT_EQ(one.wait(1), "!01 2 IDLE --\r\n");
  EXPECT_EQ(one("1 0 7 help"), "@01 0 07 OK IDLE -- 0\r\n#01 0 07 see the ASCII protocol manual\r\n");
  // A checksum on the command is not one on the reply.
  EXPECT_EQ(one("1 0 :5F"), "@01 0 OK IDLE -- 0\r\n");
  EXPECT_EQ(one("1 0 :60"), "");
  const std::string with = one("1 0 set comm.checksum 1");
  EXPECT_EQ(with.substr(0, with.size() - 5), "@01 0 OK IDLE -- 0");
  EXPECT_EQ(with[with.size() - 5], ':');
}

TEST(ZaberEmulator, CountsFromWhereItWasSwitchedOn) {
  Device one;
  one("1 1 move abs 200000");
  one.wait(2);
  EXPECT_EQ(one("1 0 system reset"), "@01 0 OK IDLE WR 0\r\n");
  EXPECT_EQ(one("1 0 get pos"), "@01 0 OK IDLE WR 0 0 0\r\n");
  EXPECT_NEAR(one.place().x(), 200000, 0.1);
  EXPECT_EQ(one("1 1 home"), "@01 1 OK BUSY WR 0\r\n");
  one.wait(10);
  EXPECT_EQ(one("1 1 get pos"), "@01 1 OK IDLE -- 0\r\n");
  EXPECT_NEAR(one.place().x(), 0, 0.1);
}

}  // namespace
}  // namespace microinjection
