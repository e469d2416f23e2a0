#include <algorithm>

#include "hardware/devices/driver_fixture.h"

namespace microinjection {
namespace {

struct LineChange {
  std::string from, to;
  int first = 0, times = 1;  ///< of the lines that are `from`
};

/// A card on a line that changes lines of a text on the way to it, or replies on the way back.
class ChangingLine : public ManipulatorEmulator {
 public:
  explicit ChangingLine(const LineChange& change, const LineChange& of_replies = {})
      : change_(change), of_replies_(of_replies) {}

  Eigen::Vector3d position() const override { return card_.position(); }
  int movesBegun() const override { return card_.movesBegun(); }
  bool moves() const override { return card_.moves(); }
  void shiftByHand(const Eigen::Vector3d& way) override { card_.shiftByHand(way); }
  /// The lines that have arrived.
  const std::vector<std::string>& heard() const { return heard_; }
  long heard(const std::string& line) const { return std::count(heard_.begin(), heard_.end(), line); }

 protected:
  void process(const std::string& bytes, double time) override {
    for (const std::string& line : ended(line_, bytes)) {
      heard_.push_back(changed(change_, seen_, line));
      card_.receive(heard_.back() + "\r", time);
    }
  }
  std::string produce(double time) override {
    std::string all;
    for (const std::string& line : ended(reply_, card_.send(time))) {
      all += changed(of_replies_, replies_seen_, line) + "\r";
    }
    return all;
  }
  void checkError(const std::string&) const override {}
  void failNextCommand(const std::string&) override {}
  void interrupt(double) override {}

 private:
  /// Adds bytes to the beginning of a line, and takes out the lines that have ended.
  static std::vector<std::string> ended(std::string& begun, const std::string& bytes) {
    std::vector<std::string> lines;
    for (const char each : bytes) {
      if (each != '\r') {
        begun += each;
      } else {
        lines.push_back(std::exchange(begun, ""));
      }
    }
    return lines;
  }
  static std::string changed(const LineChange& change, int& seen, const std::string& line) {
    if (line != change.from || line.empty()) return line;
    const int number = seen++ - change.first;
    return number >= 0 && number < change.times ? change.to : line;
  }

  ScientificaEmulator card_;
  LineChange change_, of_replies_;
  int seen_ = 0, replies_seen_ = 0;
  std::string line_, reply_;
  std::vector<std::string> heard_;
};

constexpr int kAlways = 1 << 20;

using ScientificaTest = DriverTest<TestedScientifica>;

ScientificaConfig oldCard() {
  ScientificaConfig config = TestedScientifica::config();
  config.version = 2;
  config.port.baud = 9600;
  return config;
}
ScientificaEmulatorConfig oldDevice() {
  ScientificaEmulatorConfig device;
  device.version = "2.13";
  return device;
}

TEST_F(ScientificaTest, ACardOfVersion2CountsTenths) {
  make(oldDevice(), oldCard());
  start();
  rig_->driver().moveTo(kPlace, 0.5e-3);
  ASSERT_TRUE(rig_->runUntilArrived()) << rig_->driver().reason();
  expectNear(rig_->place(), kPlace, 0.1e-6);
  EXPECT_DOUBLE_EQ(rig_->driver().abilities().resolution, 0.1e-6);
}

TEST_F(ScientificaTest, WhatIsSlowerThanTheCardGoesInSteps) {
  make(oldDevice(), oldCard());
  start();
  const double from = rig_->time(), way = (kPlace - rig_->place()).norm(), speed = 20e-6;
  const Eigen::Vector3d start = rig_->place();
  double ahead = 0;
  rig_->driver().moveTo(kPlace, speed);
  ASSERT_TRUE(rig_->runUntil(
      [&] {
        ahead = std::max(ahead, (rig_->place() - start).norm() - speed * (rig_->time() - from));
        return rig_->time() > from + 1 && !rig_->driver().moving();
      },
      20));
  expectNear(rig_->place(), kPlace, 0.1e-6);
  EXPECT_LT(ahead, speed * 0.05 + 0.2e-6);  // a step
  EXPECT_GT(rig_->time() - from, 0.95 * way / speed);
  EXPECT_LT(rig_->time() - from, 2.5 * way / speed);
}

TEST(ScientificaConfigTest, AnAccelerationTooSlowForAShortMoveIsRefused) {
  const auto read = [](double acceleration, double segment_time) {
    YAML::Node file = YAML::Load("{port: {path: none}, speed: 1.0e-3, directions: [1, 1, 1], origin: [0, 0, 0]}");
    file["acceleration"] = acceleration;
    file["segment_time"] = segment_time;
    ConfigReader reader(file, "scientifica.yaml");
    ScientificaConfig::read(reader);
    reader.finish();
  };
  EXPECT_NO_THROW(read(0.02, 0.05));
  EXPECT_NO_THROW(read(0.002, 0.5));
  try {
    read(0.01, 0.05);
    FAIL();
  } catch (const ConfigError& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("acceleration = 0.01"), std::string::npos) << what;
    EXPECT_NE(what.find("at least speed / segment_time = 0.02"), std::string::npos) << what;
  }
}

/// A driver on such a line, of one axis' move at 100 um/s.
struct ChangedLine {
  using Rig = EmulatedRig<ScientificaDriver, ScientificaConfig>;
  using State = ManipulatorDevice::State;
  static constexpr double kSpeed = 100e-6;  // m/s

  explicit ChangedLine(const LineChange& change, const LineChange& of_replies = {})
      : line(std::make_shared<ChangingLine>(change, of_replies)), rig(TestedScientifica::config(), line) {}
  /// The fastest that the needle has been for 10 ms (m/s).
  double fastest(double duration) {
    double fastest = 0, next = rig.time();
    Eigen::Vector3d before = line->position();
    rig.run(duration, [&] {
      if (rig.time() < next) return;
      fastest = std::max(fastest, (line->position() - before).norm() / 10e-3);
      before = line->position();
      next = rig.time() + 10e-3 - 1e-9;
    });
    return fastest;
  }
  void move() { rig.driver().moveTo(Eigen::Vector3d(10e-6, 60e-6, -20e-6), kSpeed); }

  std::shared_ptr<ChangingLine> line;
  Rig rig;
};

TEST(ScientificaSettingTest, ASpeedThatTheLineHasChangedIsSentAgainBeforeTheMove) {
  ChangedLine changed({"TOP 100", "TOP 900", 0, 2});
  ASSERT_TRUE(changed.rig.runUntilReady());
  changed.move();
  EXPECT_LT(changed.fastest(2), 1.1 * ChangedLine::kSpeed);
  EXPECT_EQ(changed.rig.driver().reason(), "");
  EXPECT_FALSE(changed.rig.driver().moving());
  EXPECT_EQ(changed.line->heard("TOP 900"), 2);
  EXPECT_EQ(changed.line->heard("TOP 100"), 1);
  EXPECT_EQ(changed.line->movesBegun(), 1);
}

TEST(ScientificaSettingTest, ASpeedThatTheLineAlwaysChangesIsAFaultAndNothingMoves) {
  ChangedLine changed({"TOP 100", "TOP 900", 0, kAlways});
  ASSERT_TRUE(changed.rig.runUntilReady());
  changed.move();
  changed.rig.run(2);
  EXPECT_EQ(changed.rig.driver().state(), ManipulatorDevice::State::kFault);
  EXPECT_NE(changed.rig.driver().reason().find("does not keep the setting \"TOP 100\": it answers \"900\" to \"TOP\""),
            std::string::npos)
      << changed.rig.driver().reason();
  EXPECT_EQ(changed.line->movesBegun(), 0);
}

TEST(ScientificaSettingTest, AReplyThatTheLineHasChangedIsAskedForAgain) {
  ChangedLine changed({}, {"100", "900", 0, 1});
  ASSERT_TRUE(changed.rig.runUntilReady());
  changed.move();
  changed.rig.run(2);
  EXPECT_EQ(changed.rig.driver().reason(), "");
  EXPECT_EQ(changed.line->heard("TOP 100"), 1);
  EXPECT_EQ(changed.line->heard("TOP"), 2);
  EXPECT_EQ(changed.line->movesBegun(), 1);
}

TEST(ScientificaSettingTest, AStopBeforeTheSpeedIsReadBackDoesNotMakeItRight) {
  ChangedLine changed({"TOP 100", "TOP 900", 0, 1});
  ASSERT_TRUE(changed.rig.runUntilReady());
  changed.move();
  ASSERT_TRUE(changed.rig.runUntil([&] { return changed.line->heard("TOP 900") > 0; }, 1));
  changed.rig.run(4e-3);  // its reply
  changed.rig.driver().stop();
  ASSERT_TRUE(changed.rig.runUntilArrived(1));
  changed.move();
  EXPECT_LT(changed.fastest(2), 1.1 * ChangedLine::kSpeed);
  EXPECT_EQ(changed.line->movesBegun(), 1);
}

TEST(ScientificaSettingTest, AnAccelerationThatTheLineHasChangedIsSentAgain) {
  ChangedLine changed({"ACC 30000", "ACC 10000", 1, 1});  // the second, whose reply makes two
  ASSERT_TRUE(changed.rig.runUntilReady());
  const auto& heard = changed.line->heard();
  const auto last = std::find_if(heard.rbegin(), heard.rend(), [](const auto& each) { return each.find("ACC ") == 0; });
  ASSERT_NE(last, heard.rend());
  EXPECT_EQ(*last, "ACC 30000");
}

TEST(ScientificaSettingTest, SettingsOfTheStartThatTheLineAlwaysChangesAreAFault) {
  for (const LineChange& each :
       {LineChange{"ACC 30000", "ACC 10000", 0, kAlways}, {"FIRST 1", "FIRST 9", 0, kAlways}}) {
    ChangedLine changed(each);
    changed.rig.run(3);
    EXPECT_EQ(changed.rig.driver().state(), ManipulatorDevice::State::kFault);
    EXPECT_NE(changed.rig.driver().reason().find("does not keep the setting \"" + each.from + "\""), std::string::npos)
        << changed.rig.driver().reason();
  }
}

struct Refusal {
  ScientificaEmulatorConfig device;
  std::string why;
};

TEST_F(ScientificaTest, ACardWithOtherUnitsIsRefusedWithItsAnswerAndMovesNothing) {
  ScientificaEmulatorConfig maker, version, future, scale;
  maker.maker = "X1";
  version.version = "2.13";
  future.version = "4.01";
  scale.scale = 2540;
  for (const Refusal& each : {Refusal{maker, "answers \"X1\" to \"SCIENTIFICA\": no card of Scientifica's"},
                              {version, "answers \"2.13\" to \"VER\": the file has version 3"},
                              {future, "answers \"4.01\" to \"VER\": the file has version 3"},
                              {scale, "answers \"2540.00\" to \"USTEP X\": its positions have another unit"}}) {
    SCOPED_TRACE(each.why);
    make(each.device);
    rig_->run(6, [&] {
      rig_->driver().moveTo(kPlace, 1e-3);
      EXPECT_FALSE(rig_->driver().reading());
    });
    EXPECT_EQ(rig_->driver().state(), State::kFault);
    EXPECT_NE(rig_->driver().reason().find(each.why), std::string::npos) << rig_->driver().reason();
    EXPECT_EQ(rig_->device().movesBegun(), 0);
  }
}

}  // namespace
}  // namespace microinjection
