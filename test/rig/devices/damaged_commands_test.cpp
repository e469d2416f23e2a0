// A line that changes a bit of what the driver says: the device does what nobody has asked for.

#include <random>

#include "rig/devices/driver_fixture.h"

namespace microinjection {
namespace {

/// An emulator one of whose received bytes has a bit turned.
class DamagedCommands : public ManipulatorEmulator {
 public:
  DamagedCommands(std::shared_ptr<ManipulatorEmulator> device, unsigned seed)
      : device_(std::move(device)), random_(seed) {}

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
      if (left_ >= 0 && left_-- == 0) byte ^= static_cast<char>(1 << (random_() % 8));
    }
    device_->receive(arrives, time);
  }
  std::string produce(double time) override { return device_->send(time); }
  void checkError(const std::string&) const override {}
  void failNextCommand(const std::string&) override {}
  void interrupt(double) override {}

 private:
  std::shared_ptr<ManipulatorEmulator> device_;
  std::mt19937 random_;
  int left_ = 1 << 30;
};

/// Distance (m) of a place from the straight way.
double offTheWay(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Eigen::Vector3d& place) {
  const Eigen::Vector3d way = to - from;
  const double share = std::min(1.0, std::max(0.0, (place - from).dot(way) / way.squaredNorm()));
  return (from + share * way - place).norm();
}

constexpr double kOffAtAnySpeed = 1e-6;  // m

/// Those on a serial line; a network's datagrams have a checksum.
using AllSerial = testing::Types<TestedZaber, TestedMp285, TestedEppendorf, TestedTransferman, TestedScientifica>;
template <typename Tested>
class DamagedCommandsTest : public testing::Test {};
TYPED_TEST_SUITE(DamagedCommandsTest, AllSerial, Names);

/// Of a move of 0.6 s, aslant or along one axis.
template <typename TypeParam>
void expectDamagedCommandsMoveLittle(double speed) {
  constexpr double kNoLonger = 0.2, kDuration = 0.6;            // s
  const double off_limit = speed * kNoLonger + kOffAtAnySpeed;  // m
  int damaged = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const auto device = std::make_shared<DamagedCommands>(std::make_shared<typename TypeParam::Emulator>(), seed);
    EmulatedRig<typename TypeParam::Driver, typename TypeParam::Config> rig(TypeParam::config(), device);
    ASSERT_TRUE(rig.runUntilReady(10));
    const auto place = [&] { return TypeParam::config().joints.toJoints(TypeParam::inJointOrder(device->position())); };
    const Eigen::Vector3d from = place();
    const Eigen::Vector3d way = (seed % 2 ? Eigen::Vector3d(2, -1, 2) : Eigen::Vector3d(1, 0, 0)).normalized();
    const Eigen::Vector3d to = from + speed * kDuration * way;
    device->damageAfter(static_cast<int>(seed));
    rig.driver().moveTo(to, speed);
    double off = 0, untrue = 0;
    rig.run(3, [&] {
      off = std::max(off, offTheWay(from, to, place()));
      const auto told = rig.driver().reading();
      if (told) untrue = std::max(untrue, (told->joints - place()).norm());
    });
    damaged += device->damaged();
    EXPECT_LT(off, off_limit) << "seed " << seed << ", " << rig.driver().reason();
    EXPECT_LT(untrue, off_limit) << "seed " << seed << ", " << rig.driver().reason();
  }
  EXPECT_EQ(damaged, 40);
}

TYPED_TEST(DamagedCommandsTest, MoveTheNeedleByLittleAndNoPlaceThatIsToldIsFarFromTheTruth) {
  for (const double speed : {10e-6, 100e-6, std::min(1000e-6, TypeParam::kFastest)}) {  // m/s
    SCOPED_TRACE(1e6 * speed);
    expectDamagedCommandsMoveLittle<TypeParam>(speed);
  }
}

}  // namespace
}  // namespace microinjection
