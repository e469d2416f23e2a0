// A line that changes a bit of what the driver says: the device does what nobody has asked for.

#include <random>
#include <regex>
#include <type_traits>
#include <utility>

#include "hardware/devices/driver_fixture.h"

namespace microinjection {
namespace {

/// An emulator one of whose received bytes has a bit turned.
class DamagedCommands : public ManipulatorEmulator {
 public:
  DamagedCommands(std::shared_ptr<ManipulatorEmulator> device, unsigned bit)
      : device_(std::move(device)), bit_(static_cast<char>(1 << bit)) {}

  Eigen::Vector3d position() const override { return device_->position(); }
  int movesBegun() const override { return device_->movesBegun(); }
  bool moves() const override { return device_->moves(); }
  void shiftByHand(const Eigen::Vector3d& way) override { device_->shiftByHand(way); }
  /// The byte behind the next `skip` ones.
  void damageAfter(int skip) { left_ = skip; }
  bool damaged() const { return left_ < 0; }

 protected:
  void process(const std::string& bytes, double time) override {
    std::string arrives = bytes;
    for (char& byte : arrives) {
      if (left_ >= 0 && left_-- == 0) byte ^= bit_;
    }
    device_->receive(arrives, time);
  }
  std::string produce(double time) override { return device_->send(time); }
  void checkError(const std::string&) const override {}
  void failNextCommand(const std::string&) override {}
  void interrupt(double) override {}

 private:
  std::shared_ptr<ManipulatorEmulator> device_;
  char bit_;
  int left_ = 1 << 30;
};

/// Distance (m) of a place from the straight way.
double offTheWay(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Eigen::Vector3d& place) {
  const Eigen::Vector3d way = to - from;
  const double share = std::min(1.0, std::max(0.0, (place - from).dot(way) / way.squaredNorm()));
  return (from + share * way - place).norm();
}

/// Distance (m) along the way by which a place is ahead of one that has been moving from its begin at `speed` (m/s) for
/// `duration` (s); the way ends.
double aheadOfTheWay(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Eigen::Vector3d& place, double speed,
                     double duration) {
  const Eigen::Vector3d way = to - from;
  return (place - from).dot(way.normalized()) - std::min(way.norm(), speed * duration);
}

constexpr double kOffAtAnySpeed = 1e-6;  // m

/// Those on a serial line; a network's datagrams have a checksum.
using AllSerial = testing::Types<TestedZaber, TestedMp285, TestedEppendorf, TestedTransferman, TestedScientifica>;
template <typename Tested>
class DamagedCommandsTest : public testing::Test {};
TYPED_TEST_SUITE(DamagedCommandsTest, AllSerial, Names);

constexpr double kNoLonger = 0.2, kDuration = 0.6;  // s

/// How far (m) the needle was astray while one bit of a move's bytes was turned.
struct Astray {
  double off = 0;     ///< beside the way
  double ahead = 0;   ///< of the commanded motion
  double untrue = 0;  ///< a place that was told, of the truth
  bool damaged = false;
  std::string reason;  ///< of the driver
};

/// Of a move of 0.6 s, aslant or along one axis. `byte`: counted from the command on.
template <typename Tested>
Astray moveDamaged(double speed, int byte, unsigned bit) {
  const auto device = std::make_shared<DamagedCommands>(std::make_shared<typename Tested::Emulator>(), bit);
  EmulatedRig<typename Tested::Driver, typename Tested::Config> rig(Tested::config(), device);
  EXPECT_TRUE(rig.runUntilReady(10));
  const auto place = [&] { return Tested::config().joints.toJoints(Tested::inJointOrder(device->position())); };
  const Eigen::Vector3d from = place();
  const Eigen::Vector3d way = (byte % 2 ? Eigen::Vector3d(2, -1, 2) : Eigen::Vector3d(1, 0, 0)).normalized();
  const Eigen::Vector3d to = from + speed * kDuration * way;
  device->damageAfter(byte);
  rig.driver().moveTo(to, speed);
  const double begin = rig.time();
  Astray most;
  rig.run(3, [&] {
    most.off = std::max(most.off, offTheWay(from, to, place()));
    most.ahead = std::max(most.ahead, aheadOfTheWay(from, to, place(), speed, rig.time() - begin));
    const auto told = rig.driver().reading();
    if (told) most.untrue = std::max(most.untrue, (told->joints - place()).norm());
  });
  most.damaged = device->damaged();
  most.reason = rig.driver().reason();
  return most;
}

/// In 40 bytes, any bit: m, by which the needle and a place that is told may be astray. Speed or goal of a line have
/// changed until a reading tells it, and the device is stopped; near the way it takes whole counts.
template <typename Tested>
double astrayAtMost(double speed, int byte, unsigned bit) {
  const double at_any_speed = kOffAtAnySpeed + 2 * Tested::kStep;
  // It turns C006 into C007: microsteps are taken for micrometres, which are 25.6 of them. That is seen by the first
  // reading, and the device has stopped after 40 ms.
  const bool in_other_units = std::is_same_v<Tested, TestedTransferman> && byte == 3 && bit == 0;
  return at_any_speed + speed * (in_other_units ? 25.6 * 40e-3 : kNoLonger);
}

template <typename Tested>
std::vector<double> speedsOf() {
  return {10e-6, 100e-6, std::min(1000e-6, Tested::kFastest)};  // m/s
}

TYPED_TEST(DamagedCommandsTest, MoveTheNeedleByLittleAndNoPlaceThatIsToldIsFarFromTheTruth) {
  for (const double speed : speedsOf<TypeParam>()) {
    SCOPED_TRACE(1e6 * speed);
    const double off_limit = speed * kNoLonger + kOffAtAnySpeed;  // m
    int damaged = 0;
    for (unsigned seed = 1; seed <= 40; ++seed) {
      const unsigned bit = std::mt19937(seed)() % 8;
      const Astray astray = moveDamaged<TypeParam>(speed, static_cast<int>(seed), bit);
      damaged += astray.damaged;
      EXPECT_LT(astray.off, off_limit) << "seed " << seed << ", " << astray.reason;
      EXPECT_LT(astray.ahead, off_limit) << "seed " << seed << ", " << astray.reason;
      EXPECT_LT(astray.untrue, off_limit) << "seed " << seed << ", " << astray.reason;
    }
    EXPECT_EQ(damaged, 40);
  }
}

TYPED_TEST(DamagedCommandsTest, WithAnyOfTheirBitsTurnedLeadTheNeedleNeitherFarBesideNorFarAhead) {
  for (const double speed : speedsOf<TypeParam>()) {
    SCOPED_TRACE(1e6 * speed);
    for (int i = 0; i < 40 * 8; ++i) {
      const int byte = 1 + i / 8;
      const unsigned bit = i % 8;
      const Astray astray = moveDamaged<TypeParam>(speed, byte, bit);
      const double limit = astrayAtMost<TypeParam>(speed, byte, bit);
      EXPECT_TRUE(astray.damaged);
      EXPECT_LT(astray.off, limit) << "byte " << byte << ", bit " << bit << ", " << astray.reason;
      EXPECT_LT(astray.ahead, limit) << "byte " << byte << ", bit " << bit << ", " << astray.reason;
      EXPECT_LT(astray.untrue, limit) << "byte " << byte << ", bit " << bit << ", " << astray.reason;
    }
  }
}

/// An Eppendorf whose first lines to move it say nine times the speed.
class FasterThanTold : public DamagedCommands {
 public:
  explicit FasterThanTold(int lines) : DamagedCommands(std::make_shared<EppendorfEmulator>(), 0), left_(lines) {}

 protected:
  void process(const std::string& bytes, double time) override {
    for (const char each : bytes) {
      line_ += each;
      if (each != '\r') continue;
      DamagedCommands::process(changed(std::exchange(line_, "")), time);
    }
  }

 private:
  std::string changed(const std::string& line) {
    static const std::regex form(R"((C012(?: *[ +-]\d+){3}) *[ +](\d+) *[ +](\d+) *[ +](\d+)\r)");
    std::smatch found;
    if (left_ == 0 || !std::regex_match(line, found, form)) return line;
    --left_;
    std::string faster = found[1];
    for (int i = 2; i < 5; ++i) faster += " " + std::to_string(9 * std::stol(found[i]));
    return faster + "\r";
  }

  int left_;
  std::string line_;
};

struct FastRig : EmulatedRig<EppendorfDriver, EppendorfConfig> {
  explicit FastRig(const std::shared_ptr<ManipulatorEmulator>& device)
      : EmulatedRig(TestedEppendorf::config(), device) {}
  void move() { driver().moveTo(Eigen::Vector3d(10e-6, 400e-6, -20e-6), 100e-6); }
};

TEST(TooFastTest, OneMoveIsStoppedAndGoesOnAtItsSpeed) {
  const auto device = std::make_shared<FasterThanTold>(1);
  FastRig rig(device);
  ASSERT_TRUE(rig.runUntilReady());
  const double begin = rig.time();
  rig.move();
  ASSERT_TRUE(rig.runUntilArrived()) << rig.driver().reason();
  EXPECT_GT(rig.time() - begin, 0.9 * 400 / 100);
  expectNear(rig.read(), Eigen::Vector3d(10e-6, 400e-6, -20e-6), 1e-6);
  EXPECT_EQ(rig.driver().state(), ManipulatorDevice::State::kReady);
}

TEST(TooFastTest, TwoInARowAreAFaultThatTellsIt) {
  const auto device = std::make_shared<FasterThanTold>(2);
  FastRig rig(device);
  ASSERT_TRUE(rig.runUntilReady());
  rig.move();
  rig.run(3);
  EXPECT_EQ(rig.driver().state(), ManipulatorDevice::State::kFault);
  EXPECT_NE(rig.driver().reason().find("moves faster than it was told"), std::string::npos) << rig.driver().reason();
  EXPECT_FALSE(device->moves());
  EXPECT_LT((device->position()).norm(), 200e-6);
}

/// A program that stood still hears of a device that went on.
template <typename Tested>
class StandstillTest : public testing::Test {};
TYPED_TEST_SUITE(StandstillTest, AllMoveByMove, Names);

TYPED_TEST(StandstillTest, OfTheProgramIsNoMoveThatIsTooFast) {
  for (int i = 0; i < 40; ++i) {
    const auto device = std::make_shared<typename TypeParam::Emulator>();
    EmulatedRig<typename TypeParam::Driver, typename TypeParam::Config> rig(TypeParam::config(), device);
    ASSERT_TRUE(rig.runUntilReady(10));
    rig.driver().moveTo(rig.read() + Eigen::Vector3d(100e-6, 0, 0), 100e-6);
    rig.run(2e-3 * (i + 1));
    rig.standStill(0.02 * (i % 8 + 1));
    rig.run(5, [&] { EXPECT_EQ(rig.driver().state(), ManipulatorDevice::State::kReady) << rig.driver().reason(); });
    EXPECT_FALSE(rig.driver().moving());
    if (!TypeParam::kInParts) EXPECT_EQ(device->movesBegun(), 1) << i;
  }
}

}  // namespace
}  // namespace microinjection
