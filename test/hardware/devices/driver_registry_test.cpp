#include "hardware/devices/driver_registry.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <stdexcept>
#include <thread>
#include <utility>

#include "base/errors.h"
#include "hardware/serial/emulator_host.h"
#include "hardware/serial/serial_port.h"

namespace microinjection {
namespace {

using State = ManipulatorDevice::State;

YAML::Node delivered(const DriverEntry& rig) {
  return loadYamlMap(MICROINJECTION_SOURCE_DIR "/config/rigs/" + rig.name + ".yaml");
}

std::unique_ptr<ManipulatorDevice> make(const DriverEntry& rig, const YAML::Node& config,
                                        std::unique_ptr<Wire> wire = nullptr) {
  ConfigReader reader(config, rig.name + ".yaml");
  return rig.make_driver(reader, std::move(wire));
}

TEST(DriverRegistry, FindsRigsAndNamesThemAll) {
  EXPECT_EQ(findDriver("mp285").name, "mp285");
  try {
    findDriver("joystick");
    FAIL();
  } catch (const ConfigError& error) {
    for (const DriverEntry& rig : driverEntries())
      EXPECT_NE(std::string(error.what()).find(rig.name), std::string::npos);
  }
}

TEST(DriverRegistry, EveryDeliveredConfigurationIsReadAndWrongOnesAreRefused) {
  for (const DriverEntry& rig : driverEntries()) {
    SCOPED_TRACE(rig.name);
    const auto driver = make(rig, delivered(rig));
    EXPECT_EQ(driver->state(), State::kDisconnected);
    EXPECT_NE(driver->reason(), "");
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

/// A serial port to an emulator that is stepped with it. What one side has sent is waited for at the other, so that the
/// time in which the kernel carries it is none of the driver's and the device's.
class HostedPort : public Wire {
 public:
  HostedPort(const SerialPortConfig& config, EmulatorHost& host) : port_(config), host_(host) {}

  std::string open() override { return port_.open(); }
  bool isOpen() const override { return port_.isOpen(); }
  void write(const std::string& bytes, double time) override {
    port_.write(bytes, time);
    to_device_ += bytes.size();
  }
  std::string read(double time) override {
    std::string said, read;
    await([&] {
      const EmulatorHost::Exchange exchange = host_.step(time);
      to_device_ -= exchange.received.size();
      said += exchange.sent;
      return to_device_ == 0;
    });
    await([&] { return (read += port_.read(time)).size() >= said.size(); });
    return read;
  }
  void disconnectCable() {
    host_.disconnectCable();
    await([&] { return port_.read(0).empty() && !port_.isOpen(); });
    to_device_ = 0;
  }
  void connectCable() { host_.connectCable(); }

 private:
  /// Only what hangs takes so long.
  static void await(const std::function<bool()>& done) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!done()) {
      if (std::chrono::steady_clock::now() > end) throw std::runtime_error("bytes are lost on the pseudo-terminal");
      std::this_thread::yield();
    }
  }

  SerialPort port_;
  EmulatorHost& host_;
  std::size_t to_device_ = 0;  // bytes on their way
};

TEST(DriverRegistry, DriverAndEmulatorMeetOnAPseudoTerminal) {
  for (const DriverEntry& rig : driverEntries()) {
    SCOPED_TRACE(rig.name);
    SerialPortConfig port_config;
    port_config.path = testing::TempDir() + "rig_registry_test_" + std::to_string(getpid());
    port_config.baud = rig.default_baud;
    EmulatorHost host(rig.make_emulator(), rig.default_baud, port_config.path);
    auto wire = std::make_unique<HostedPort>(port_config, host);
    HostedPort& port = *wire;
    const auto driver = make(rig, delivered(rig), std::move(wire));
    double time = 0;  // s
    const auto step_until = [&](const std::function<bool()>& done) {
      for (const double end = time + 10; time < end && !done(); time += 1e-3) driver->step(time);
      return done();
    };
    const Eigen::Vector3d goal(20e-6, -10e-6, 5e-6);
    const auto ready = [&] { return driver->state() == State::kReady; };
    const auto arrived = [&] {
      return ready() && (driver->reading()->joints - goal).norm() < 2 * driver->abilities().resolution;
    };
    ASSERT_TRUE(step_until(ready)) << driver->reason();
    driver->moveTo(goal, 1e-3);
    ASSERT_TRUE(step_until(arrived)) << driver->reason();
    port.disconnectCable();
    ASSERT_TRUE(step_until([&] { return driver->state() == State::kDisconnected; }));
    port.connectCable();
    ASSERT_TRUE(step_until(ready)) << driver->reason();
    EXPECT_TRUE(arrived());
  }
}

}  // namespace
}  // namespace microinjection
