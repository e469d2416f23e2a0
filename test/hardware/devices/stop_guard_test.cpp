// A program that stands still, or whose stop guard does, leaves no device in motion, and sets none in motion again by
// itself. The device is emulated on a pseudo-terminal; its time never runs faster than the wall's.

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "../manipulator/rig_file.h"
#include "hardware/devices/driver_fixture.h"
#include "hardware/manipulator/micromanipulator.h"
#include "hardware/serial/emulator_host.h"
#include "hardware/serial/serial_port.h"

namespace microinjection {
namespace {

using State = ManipulatorDevice::State;
constexpr int kPatience = 40000;  // steps of some 0.4 ms

double wallTime() {  // s
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string newLink() { return testing::TempDir() + "stop_guard_rig_test_" + std::to_string(getpid()); }

/// An emulated device, stepped by the test.
class Bench {
 public:
  Bench(std::shared_ptr<ManipulatorEmulator> device, double baud, const std::string& link)
      : device_(device), host_(std::move(device), baud, link) {}

  void step() {
    std::this_thread::sleep_for(std::chrono::microseconds(300));
    const double wall = wallTime();
    longest_ = std::max(longest_, wall - wall_);
    host_.step(time_ += std::min(wall - wall_, 2e-3));
    wall_ = wall;
  }
  /// Whether the machine has held this program up so long that exchanges may have been broken off.
  bool heldUp() const { return longest_ > 0.02; }
  ManipulatorEmulator& device() { return *device_; }
  double time() const { return time_; }  // s

 private:
  std::shared_ptr<ManipulatorEmulator> device_;
  EmulatorHost host_;
  double time_ = 0, wall_ = wallTime(), longest_ = 0;  // s
};

/// A driver in this program, which steps it or does not.
template <typename Tested>
class GuardedRigTest : public testing::Test {
 protected:
  void SetUp() override {
    auto config = Tested::config();
    config.port.path = link_;
    auto port = std::make_unique<SerialPort>(config.port);
    port_ = port.get();
    driver_ = std::make_unique<typename Tested::Driver>(config, std::move(port));
    bench_ = std::make_unique<Bench>(std::make_shared<typename Tested::Emulator>(), config.port.baud, link_);
    beginMove(kFar);
  }
  bool until(const std::function<bool()>& done, bool steps = true) {
    for (int i = 0; i < kPatience && !done(); ++i) {
      bench_->step();
      if (!steps) continue;
      driver_->step(bench_->time());
      if (driver_->state() != State::kReady) reasons_ += driver_->reason() + "\n";
    }
    return done();
  }
  void run(int steps) {
    until([&] { return steps-- == 0; });
  }
  /// Where the machine broke off exchanges again and again, which is a fault, an operator clears it; another fault
  /// stays.
  bool untilReady() {
    return until([&] {
      if (driver_->state() == State::kFault && bench_->heldUp()) driver_->clearFault();
      return driver_->state() == State::kReady;
    });
  }
  bool moves() { return bench_->device().moves(); }
  void beginMove(const Eigen::Vector3d& place) {
    ASSERT_TRUE(untilReady()) << driver_->reason();
    // Commanded again where the machine held this program up so long that the guard was right.
    int moving = 0;  // steps
    ASSERT_TRUE(until([&] {
      driver_->moveTo(place, 0.2e-3);
      moving = moves() ? moving + 1 : 0;
      return moving > 100;
    }));
    reasons_.clear();
  }
  /// The device was stopped, rests until the next command, and follows that.
  void expectRestUntilCommanded(
      const std::string& why, const std::function<void()>& at_rest = [] {}) {
    ASSERT_TRUE(until([&] { return reasons_.find(why) != std::string::npos; })) << reasons_;
    ASSERT_TRUE(untilReady()) << driver_->reason();
    EXPECT_FALSE(moves());
    EXPECT_FALSE(driver_->moving());
    at_rest();
    const Eigen::Vector3d place = bench_->device().position();
    run(1000);
    expectNear(bench_->device().position(), place, 0);
    beginMove(-kFar);
  }

  const Eigen::Vector3d kFar{5e-3, 0, 0};  // m
  const std::string link_ = newLink();
  std::unique_ptr<Bench> bench_;
  std::unique_ptr<ManipulatorDevice> driver_;
  SerialPort* port_ = nullptr;
  std::string reasons_;
};
TYPED_TEST_SUITE(GuardedRigTest, AllTested, Names);

TYPED_TEST(GuardedRigTest, ACycleThatDoesNotStepLeavesNothingInMotion) {
  const double from = this->bench_->time();
  // The short move of some devices ends before the guard stops them.
  ASSERT_TRUE(this->until([&] { return !this->moves() && this->bench_->time() > from + 0.5; }, false));
  const Eigen::Vector3d place = this->bench_->device().position();
  this->driver_->moveTo(-this->kFar, 1e-3);  // asked for before it can know
  this->expectRestUntilCommanded("the program stood still for more than 0.2 s; the stop guard stopped the device",
                                 [&] { expectNear(this->bench_->device().position(), place, 0.1e-6); });
}

TYPED_TEST(GuardedRigTest, AKilledGuardIsReplacedAndTheDeviceStopped) {
  const pid_t first = this->port_->guardProcess();
  ASSERT_GT(first, 0);  // -1 would be every process
  kill(first, SIGKILL);
  ASSERT_TRUE(this->until([&] { return this->port_->guardProcess() != first; }));
  // Noticed while it wrote, a step may still end as it began.
  ASSERT_TRUE(this->until([&] { return this->driver_->state() == State::kDisconnected; }));
  this->expectRestUntilCommanded("the stop guard ended");
}

TYPED_TEST(GuardedRigTest, AFrozenGuardIsReplacedAndTheDeviceStopped) {
  const pid_t first = this->port_->guardProcess();
  ASSERT_GT(first, 0);  // -1 would be every process
  kill(first, SIGSTOP);
  ASSERT_TRUE(this->until([&] { return this->port_->guardProcess() != first; }));
  ASSERT_TRUE(this->until([&] { return kill(first, 0) != 0; }));
  this->expectRestUntilCommanded("the stop guard stood still for more than 0.2 s");
}

/// An emulated line whose guard reports what the test says.
struct GuardedWire : EmulatedWire {
  using EmulatedWire::EmulatedWire;
  GuardReport heartbeat() override { return {std::exchange(report.intervention, ""), report.missing}; }
  GuardReport report;
};

TEST(GuardedRig, NothingMovesWhileThereIsNoGuard) {
  const auto device = std::make_shared<ZaberEmulator>();
  auto owned = std::make_unique<GuardedWire>(device, 115200);
  GuardedWire& wire = *owned;
  ZaberDriver driver(TestedZaber::config(), std::move(owned));
  double time = 0;  // s
  const auto run = [&](double duration) {
    for (const double end = time + duration; time < end;) {
      driver.moveTo(kPlace + Eigen::Vector3d(1e-3, 0, 0), 0.1e-3);
      driver.step(time += 1e-3);
    }
  };
  run(1);
  ASSERT_TRUE(device->moves()) << driver.reason();
  wire.report.missing = "it ended";
  device->inject(parseFault("deaf:39"));  // the first three stops
  run(0.7);
  EXPECT_FALSE(device->moves());
  const Eigen::Vector3d place = device->position();
  run(3);
  expectNear(device->position(), place, 0);
  EXPECT_EQ(driver.state(), State::kDisconnected);
  EXPECT_EQ(driver.reason(), "Zaber: no stop guard: it ended");
  EXPECT_FALSE(driver.reading());
  wire.report.missing.clear();
  run(1);
  EXPECT_TRUE(device->moves());
}

volatile std::sig_atomic_t pauses = 0;

/// A program of its own that streams a velocity, with a pause when it gets SIGUSR1, as an operator makes it who first
/// clears a fault; it tells `reports` why it is not ready, and "ready" when it is.
[[noreturn]] void streamVelocity(const std::string& link, int reports) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  std::signal(SIGUSR1, [](int) { pauses = 1; });
  ZaberConfig config;
  config.joints.origin.setConstant(-12.5e-3);
  config.port.path = link;
  config.reply_timeout = 1;  // s: the machine may hold the emulated device up, whose silence would be a fault
  ZaberDriver driver(config, std::make_unique<SerialPort>(config.port));
  const auto geometry = ManipulatorGeometry::fromUrdf(rigUrdf(), 0);
  Micromanipulator needle(geometry, CollisionGuard(rigUrdf(), geometry, 2e-6), {}, driver);
  std::string said;
  double time = 1, wall = wallTime();  // s
  for (int pause = 0;; pause = std::max(0, pause - 1)) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    if (pauses != 0) pause = 300;
    if (pauses != 0 && driver.state() == ManipulatorDevice::State::kFault) needle.clearFault();
    pauses = 0;
    time += std::clamp(wallTime() - wall, 1e-6, 2e-3);
    wall = wallTime();
    if (pause == 0) needle.servoVelocity({0.2e-3, 0, 0}, time);
    needle.step(time, 1e-3);
    const std::string report = (needle.reason().empty() ? "ready" : needle.reason()) + "\n";
    if (report != said && write(reports, report.data(), report.size()) < 0) _exit(1);
    said = report;
  }
}

/// A velocity of its firmware goes on for ever.
std::shared_ptr<ManipulatorEmulator> olderZaber() {
  ZaberEmulatorConfig config;
  config.firmware = "6.28";
  return std::make_shared<ZaberEmulator>(config);
}

class FrozenProgramTest : public testing::Test {
 protected:
  void SetUp() override {
    int ends[2];
    ASSERT_EQ(pipe2(ends, O_NONBLOCK | O_CLOEXEC), 0);
    program_ = fork();
    if (program_ == 0) streamVelocity(link_, ends[1]);
    close(ends[1]);
    reports_ = ends[0];
  }
  void TearDown() override {
    kill(program_, SIGKILL);
    waitpid(program_, nullptr, 0);
    close(reports_);
  }
  bool until(const std::function<bool()>& done) {
    for (int i = 0; i < kPatience && !done(); ++i) {
      bench_.step();
      char text[256];
      const ssize_t size = read(reports_, text, sizeof(text));
      if (size > 0) said_.append(text, static_cast<std::size_t>(size));
    }
    return done();
  }
  void run(int steps) {
    until([&] { return steps-- == 0; });
  }
  /// A new stream each time that the machine made an exchange fail.
  bool streamsTo(double place) {
    int step = 0;
    return until([&] {
      if (step++ % 3000 == 0) kill(program_, SIGUSR1);
      return this->place() > place && bench_.device().moves();
    });
  }
  double place() { return bench_.device().position().x(); }  // m

  const std::string link_ = newLink();
  Bench bench_{olderZaber(), 115200, link_};
  pid_t program_ = -1;
  int reports_ = -1;
  std::string said_;
};

TEST_F(FrozenProgramTest, LeavesNothingInMotionAndBeginsWithANewStreamOnly) {
  const double start = place();
  ASSERT_TRUE(until([&] { return said_.find("ready\n") != std::string::npos; })) << said_;
  ASSERT_TRUE(streamsTo(start + 20e-6)) << said_;
  said_.clear();
  kill(program_, SIGSTOP);
  ASSERT_TRUE(until([&] { return !bench_.device().moves(); })) << place() - start;
  const double stopped = place();
  run(1000);
  EXPECT_EQ(place(), stopped);
  kill(program_, SIGCONT);
  const std::string why = "Zaber: the program stood still for more than 0.2 s; the stop guard stopped the device\n";
  // Where the machine holds the emulated device up, its silence is reported in between.
  ASSERT_TRUE(until([&] {
    const std::size_t told = said_.find(why);
    return told != std::string::npos && said_.find("\nready\n", told) != std::string::npos;
  })) << said_;
  run(1000);  // its stream goes on
  EXPECT_NEAR(place(), stopped, 0.1e-6);
  ASSERT_TRUE(streamsTo(stopped + 20e-6)) << said_;
  kill(program_, SIGKILL);
  ASSERT_TRUE(until([&] { return !bench_.device().moves(); }));
}

}  // namespace
}  // namespace microinjection
