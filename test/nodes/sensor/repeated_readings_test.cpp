// A sensor that hangs repeats one reading with new stamps; one that is really quiet does, too, and says so.

#include <gtest/gtest.h>

#include <random>

#include "nodes/injection/injection_chain.h"
#include "nodes/runtime/force_liveness.h"

namespace microinjection {
namespace {

/// A sensor of another node, in the tip's frame. The test is that node.
class RepeatedReadings {
 public:
  explicit RepeatedReadings(const std::vector<std::string>& overrides = {}) : session_(completed(overrides)) {
    session_.world().repeat<geometry_msgs::WrenchStamped>("force_sensor/device_cf", [this] {
      const double noise = hangs ? 0 : 10e-9 * (random_() / 2147483647.0 - 1);  // N
      return std::optional(wrenchMessage(0, 0, 1e-6 + noise, "needle_tip"));
    });
    session_.add("force_sensor", "{diagnostic_period: 0.1}");
    session_.run(0.2);
  }
  void run(double seconds) { session_.run(seconds); }
  bool valid() const { return !measured_.newest()->header.stamp.isZero(); }
  std::string status() const { return session_.diagnostics().text("force_sensor: sensor"); }

  bool hangs = false;

 private:
  static std::vector<std::string> completed(std::vector<std::string> overrides) {
    overrides.emplace_back("sensor.source:=topic");
    return overrides;
  }

  VirtualSession session_;
  std::mt19937 random_{1};
  const Probe<geometry_msgs::WrenchStamped>& measured_ =
      session_.world().hear<geometry_msgs::WrenchStamped>("force_sensor/measured_cf");
};

TEST(RepeatedReadingsTest, AreThoseOfASensorThatHangs) {
  RepeatedReadings sensor;
  EXPECT_TRUE(sensor.valid());
  EXPECT_EQ(sensor.status(), "measures");
  sensor.hangs = true;
  sensor.run(1e-3 * (ForceLiveness::kReadings - 5));
  EXPECT_TRUE(sensor.valid());
  sensor.run(0.01);
  EXPECT_FALSE(sensor.valid());
  sensor.run(0.2);
  EXPECT_FALSE(sensor.valid());
  EXPECT_EQ(sensor.status().rfind("repeats one reading", 0), 0u) << sensor.status();
  sensor.hangs = false;
  sensor.run(0.2);
  EXPECT_TRUE(sensor.valid());
  EXPECT_EQ(sensor.status(), "measures");
}

TEST(RepeatedReadingsTest, OfAQuietSensorAreValid) {
  RepeatedReadings sensor({"sensor.quiet:=true"});
  sensor.hangs = true;
  sensor.run(2);
  EXPECT_TRUE(sensor.valid());
  EXPECT_EQ(sensor.status(), "measures");
}

/// 16 bit, and noise of a tenth of their step.
std::vector<std::string> quietSensor() {
  const std::string simulated = "overrides.force_sensor.simulated.";
  return {simulated + "axial_noise_density:=2.1e-11", simulated + "lateral_noise_density:=3.8e-11",
          simulated + "axial_random_walk:=0.0",       simulated + "lateral_random_walk:=0.0",
          simulated + "axial_drift_rate:=0.0",        simulated + "lateral_drift_rate:=0.0"};
}

TEST(RepeatedReadingsTest, OfAQuietSensorNeedItsWord) {
  VirtualSession session(quietSensor());
  try {
    session.add("force_sensor");
    FAIL() << "it starts";
  } catch (const std::exception& error) {
    EXPECT_NE(std::string(error.what()).find("quiet"), std::string::npos) << error.what();
  }
}

TEST(RepeatedReadingsTest, OfAQuietSensorLeadAWholeInjection) {
  std::vector<std::string> overrides = quietSensor();
  overrides.emplace_back("sensor.quiet:=true");
  overrides.emplace_back("force.controller:=measured");
  InjectionChain chain(overrides);
  auto& measured = chain.session.world().hear<geometry_msgs::WrenchStamped>("force_sensor/measured_cf");
  chain.session.run(0.2);
  const std::size_t first = measured.count() - 100;
  for (std::size_t i = first; i < measured.count(); ++i)
    ASSERT_EQ(measured.all()[i]->wrench, measured.all()[first]->wrench) << "it is not quiet";
  chain.say("approach");
  EXPECT_TRUE(
      chain.session.until([&] { return chain.status().outcome != "none" && !chain.status().outcome.empty(); }, 30));
  EXPECT_EQ(chain.status().outcome, "injected") << chain.status();
  EXPECT_EQ(chain.injector().pulses, 1u);
}

}  // namespace
}  // namespace microinjection
