// The contract of a bus, on a RosBus: a program for a rostest, since it needs a master.
#include <ros/ros.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <future>
#include <thread>

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
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (!done() && std::chrono::steady_clock::now() < end) {
      first_->waitUntil(done, kServed);
      second_->waitUntil(done, kServed);
    }
    return done();
  }
  bool runSecond(double period, const Step& step, const std::function<bool()>& done) override {
    second_->setStep(period, [this, step, done](const ros::Time& now) {
      step(now);
      if (done()) second_->stop();
    });
    Patience patience(*second_);
    second_->run();
    return done();
  }

 private:
  static constexpr double kServed = 1e-3;               // s
  static constexpr std::chrono::seconds kPatience{30};  // only what hangs takes that long

  /// Stops a bus that goes on for longer than kPatience.
  class Patience {
   public:
    explicit Patience(Bus& bus)
        : thread_([this, &bus] {
            if (ended_.get_future().wait_for(kPatience) != std::future_status::ready) bus.stop();
          }) {}
    ~Patience() {
      ended_.set_value();
      thread_.join();
    }

   private:
    std::promise<void> ended_;
    std::thread thread_;
  };

  std::unique_ptr<RosBus> first_, second_;
};

/// Freezes this process for that many s, as SIGSTOP or a host that stands still does.
void freeze(unsigned seconds) {
  const pid_t child = fork();
  if (child == 0) {
    sleep(seconds);
    kill(getppid(), SIGCONT);
    _exit(0);
  }
  raise(SIGSTOP);
}

TEST(RosBus, WhoWasFrozenHasNotLostTheMasterMeanwhile) {
  RosBus bus;
  int steps = 0, lost = 0;
  bus.setStep(0.01, [&](const ros::Time&) {
    if (++steps == 1) freeze(7);  // longer than a master may be silent
    lost += bus.isLost();
    if (steps == 100) bus.stop();
  });
  bus.run();
  EXPECT_EQ(steps, 100);
  EXPECT_EQ(lost, 0);
}

TEST(RosBus, ALoopWhoseStepsTakeLongerThanItsPeriodLeavesTheProcessorAPeriodAfterTheThird) {
  constexpr double kPeriod = 0.01, kStep = 0.03;  // s
  RosBus bus;
  std::vector<ros::SteadyTime> begins, ends;
  bus.setStep(kPeriod, [&](const ros::Time&) {
    begins.push_back(ros::SteadyTime::now());
    while ((ros::SteadyTime::now() - begins.back()).toSec() < kStep) {
    }
    ends.push_back(ros::SteadyTime::now());
    if (ends.size() == 7) bus.stop();
  });
  bus.run();
  for (std::size_t i = 3; i < begins.size(); ++i) EXPECT_GE((begins[i] - ends[i - 1]).toSec(), kPeriod) << i;
}

TEST(RosBus, DoesNotCatchUpAfterAStall) {
  constexpr double kPeriod = 0.02;  // s
  RosBus bus;
  ros::SteadyTime stalled;
  int steps = 0;
  bus.setStep(kPeriod, [&](const ros::Time&) {
    if (++steps == 3) {
      ros::WallDuration(5.5 * kPeriod).sleep();
      stalled = ros::SteadyTime::now();
    }
    if (steps == 8) bus.stop();
  });
  bus.run();
  EXPECT_GE((ros::SteadyTime::now() - stalled).toSec(), 3.9 * kPeriod)
      << "five steps, of which the first comes at once";
}

}  // namespace

INSTANTIATE_TYPED_TEST_SUITE_P(RosBus, BusContract, RosPair);

}  // namespace microinjection

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "bus_contract");
  const ros::NodeHandle handle;
  return RUN_ALL_TESTS();
}
