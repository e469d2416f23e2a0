// The contract of a bus, on a RosBus: a program for a rostest, since it needs a master.
#include <ros/ros.h>

#include "bus_contract.h"
#include "nodes/bus/ros_bus.h"

namespace microinjection {
namespace {

/// Both ends are of one process, which has one name.
class RosPair : public BusPair {
 public:
  RosPair() : first_(std::make_unique<RosBus>()), second_(std::make_unique<RosBus>()) {}

  Bus& first() override { return *first_; }
  Bus& second() override { return *second_; }
  bool serve(const std::function<bool()>& done) override {
    return until(done, [this] {
      first_->waitUntil([] { return false; }, 0);
      second_->waitUntil([] { return false; }, 0);
    });
  }
  bool runSecond(const std::function<bool()>& done) override {
    const BusHandle watch = second_->timer(0.01, [&] {
      if (done()) second_->stop();
    });
    second_->run();
    return done();
  }

 private:
  /// A failure takes 30 s; nothing else depends on this time.
  static bool until(const std::function<bool()>& done, const std::function<void()>& serve) {
    const ros::SteadyTime end = ros::SteadyTime::now() + ros::WallDuration(30);
    while (!done() && ros::SteadyTime::now() < end) serve();
    return done();
  }

  std::unique_ptr<RosBus> first_, second_;
};

}  // namespace

INSTANTIATE_TYPED_TEST_SUITE_P(RosBus, BusContract, RosPair);

}  // namespace microinjection

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "bus_contract");
  const ros::NodeHandle handle;
  return RUN_ALL_TESTS();
}
