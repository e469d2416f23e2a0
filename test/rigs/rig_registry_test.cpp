#include "rigs/rig_registry.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <thread>

#include "base/errors.h"
#include "serial/emulator_host.h"

namespace microinjection {
namespace {

using State = ManipulatorDevice::State;

YAML::Node delivered(const Rig& rig) {
  return loadYamlMap(MICROINJECTION_SOURCE_DIR "/src/rigs/" + rig.name + "/" + rig.name + ".yaml");
}

std::unique_ptr<ManipulatorDevice> make(const Rig& rig, const YAML::Node& config) {
  ConfigReader reader(config, rig.name + ".yaml");
  return rig.make_driver(reader, nullptr);
}

TEST(RigRegistry, FindsRigsAndNamesThemAll) {
  EXPECT_EQ(findRig("mp285").name, "mp285");
  try {
    findRig("joystick");
    FAIL();
  } catch (const ConfigError& error) {
    for (const Rig& rig : rigs()) EXPECT_NE(std::string(error.what()).find(rig.name), std::string::npos);
  }
}

TEST(RigRegistry, EveryDeliveredConfigurationIsReadAndWrongOnesAreRefused) {
  for (const Rig& rig : rigs()) {
    SCOPED_TRACE(rig.name);
    const auto driver = make(rig, delivered(rig));
    EXPECT_EQ(driver->state(), State::kDisconnected);
    EXPECT_NE(driver->why(), "");
    EXPECT_GT(driver->abilities().speed, 0);
    EXPECT_GT(driver->abilities().reading_interval, 0);
    YAML::Node wrong = delivered(rig);
    wrong["axes"] = std::vector<int>{1, 1, 2};
    EXPECT_THROW(make(rig, wrong), ConfigError);
    wrong = delivered(rig);
    wrong["directions"] = std::vector<double>{1, 0.5, -1};
    EXPECT_THROW(make(rig, wrong), ConfigError);
    wrong = delivered(rig);
    wrong["sped"] = 1;
    EXPECT_THROW(make(rig, wrong), ConfigError);
    wrong = delivered(rig);
    wrong.remove("port");
    EXPECT_THROW(make(rig, wrong), ConfigError);
  }
}

/// The emulator on a real pseudo-terminal, in a thread of its own.
class HostThread {
 public:
  HostThread(const Rig& rig, const std::string& link)
      : device_(rig.make_emulator()), host_(device_, rig.default_baud, link), thread_([this] { serve(); }) {}
  ~HostThread() {
    ends_ = true;
    thread_.join();
  }
  void setPlugged(bool plugged) { wanted_ = plugged; }

 private:
  void serve() {
    const auto start = std::chrono::steady_clock::now();
    bool plugged = true;
    while (!ends_) {
      if (plugged != wanted_) (plugged = wanted_) ? host_.plug() : host_.pull();
      host_.step(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
      std::this_thread::sleep_for(std::chrono::microseconds(300));
    }
  }
  std::shared_ptr<ManipulatorEmulator> device_;
  EmulatorHost host_;
  std::atomic<bool> ends_{false}, wanted_{true};
  std::thread thread_;
};

/// Steps in real time until `done`; patience decides nothing but when to give up.
bool stepUntil(ManipulatorDevice& driver, const std::function<bool()>& done) {
  const auto start = std::chrono::steady_clock::now();
  for (double time = 0; time < 30;) {
    time = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    driver.step(time);
    if (done()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

TEST(RigRegistry, DriverAndEmulatorMeetOnAPseudoTerminal) {
  for (const Rig& rig : rigs()) {
    SCOPED_TRACE(rig.name);
    const std::string link = testing::TempDir() + "rig_registry_test_" + std::to_string(getpid());
    HostThread host(rig, link);
    YAML::Node config = delivered(rig);
    config["port"]["path"] = link;
    const auto driver = make(rig, config);
    const Eigen::Vector3d goal(20e-6, -10e-6, 5e-6);
    const auto ready = [&] { return driver->state() == State::kReady; };
    const auto arrived = [&] {
      return ready() && (driver->reading()->joints - goal).norm() < 2 * driver->abilities().resolution;
    };
    // A machine that stalls may make an exchange fail, or the guard stop the device: then it is sent again.
    ASSERT_TRUE(stepUntil(*driver, ready)) << driver->why();
    ASSERT_TRUE(stepUntil(*driver, [&] { return driver->moveTo(goal, 1e-3), arrived(); })) << driver->why();
    host.setPlugged(false);
    ASSERT_TRUE(stepUntil(*driver, [&] { return driver->state() == State::kDisconnected; }));
    host.setPlugged(true);
    ASSERT_TRUE(stepUntil(*driver, ready)) << driver->why();
    EXPECT_TRUE(arrived());
  }
}

}  // namespace
}  // namespace microinjection
