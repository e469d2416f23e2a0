// Each force sensor that is there in virtual time, with each fault of what it measures.

#include <gtest/gtest.h>

#include <random>

#include "nodes/faults/faulty_topic.h"

namespace microinjection {
namespace {

class SensorFaultsTest : public testing::TestWithParam<FaultyDevice> {
 protected:
  SensorFaultsTest() {
    TestNode& world = session_.world();
    const std::string frame = GetParam().device == "topic" ? "needle_tip" : "world";
    world.repeat("needle/measured_cp", poseMessage(0, 0, 25e-6));
    world.repeat<geometry_msgs::WrenchStamped>(source(), [this, frame] {
      const double noise = 10e-9 * (random_() / 2147483647.0 - 1);  // N
      return std::optional(wrenchMessage(0, 0, 1e-6 + noise, frame));
    });
    session_.add("force_sensor", "{diagnostic_period: 0.05}");
    faulty_.emplace(session_, "/" + source());
    session_.run(0.2);
  }
  /// What the sensor's node hears: the sensor's readings, or the force that the simulated one measures.
  static std::string source() { return GetParam().device == "topic" ? "force_sensor/device_cf" : "cell/predicted_cf"; }
  bool valid() const { return !measured_.newest()->header.stamp.isZero(); }
  bool said(const std::string& reason) const {
    const HeardDiagnostics& all = session_.diagnostics();
    return all.ever("force_sensor: sensor", reason) || all.ever("force_sensor: inputs", reason);
  }
  static std::string reason() {
    switch (GetParam().fault) {
      case DeviceFault::kFrozen:
        return "repeats one reading";
      case DeviceFault::kJumps:
        return "overloaded";
      case DeviceFault::kSecondSender:
        return "is sent by two nodes, /stranger and /world";
      default:
        return "no valid ";
    }
  }

  VirtualSession session_{{"sensor.source:=" + GetParam().device}};
  const Probe<geometry_msgs::WrenchStamped>& measured_ =
      session_.world().hear<geometry_msgs::WrenchStamped>("force_sensor/measured_cf");
  std::optional<FaultyTopic<geometry_msgs::WrenchStamped>> faulty_;
  std::mt19937 random_{1};
};

TEST_P(SensorFaultsTest, AreNoReadingAndAreSaid) {
  EXPECT_TRUE(valid());
  session_.diagnostics().clear();
  faulty_->strike(GetParam().fault, 3e-3);
  session_.run(0.2);
  EXPECT_FALSE(valid());
  EXPECT_TRUE(said(reason())) << session_.diagnostics().text("force_sensor: sensor") << "; "
                              << session_.diagnostics().text("force_sensor: inputs");
}

/// The simulated sensor has noise of its own; the force of a model that repeats is told by who is led by it.
std::vector<FaultyDevice> allFaultySensors() {
  std::vector<FaultyDevice> all;
  for (const char* device : {"simulated", "topic"}) {
    for (int fault = 0; fault < static_cast<int>(DeviceFault::kLine); ++fault) {
      const bool has_noise =
          static_cast<DeviceFault>(fault) == DeviceFault::kFrozen && device == std::string("simulated");
      if (!has_noise) all.push_back({device, static_cast<DeviceFault>(fault)});
    }
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Matrix, SensorFaultsTest, testing::ValuesIn(allFaultySensors()), faultyName);

}  // namespace
}  // namespace microinjection
