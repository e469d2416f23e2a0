#include <gtest/gtest.h>

#include <string>

#include "base/errors.h"
#include "operation/teleoperation/haptic_bridge.h"

namespace microinjection {
namespace {

TEST(HapticBridgeConfig, TheOneThatIsShippedHasTheDefaults) {
  const std::string path = std::string(MICROINJECTION_SOURCE_DIR) + "/config/haptic_bridge.yaml";
  YAML::Node map = loadYamlMap(path);
  ConfigReader reader(map, path);
  double rate = 0;
  reader.number("rate", rate, Range::positive(), ConfigReader::kRequired);
  bool force_feedback = false;
  reader.boolean("force_feedback", force_feedback);
  EXPECT_TRUE(force_feedback);
  std::string axes_file;
  reader.text("axes_file", axes_file, ConfigReader::kRequired);
  ConfigReader timeouts = reader.section("timeouts", ConfigReader::kRequired);
  for (const char* input :
       {"hand", "hand_unchanged", "clutch", "operator_present", "needle", "predicted", "measured", "controller"}) {
    double timeout = 0;
    timeouts.number(input, timeout, Range::nonNegative(), ConfigReader::kRequired);
  }
  const HapticBridgeConfig read = HapticBridgeConfig::read(reader);
  reader.finish();
  const HapticBridgeConfig defaults;
  EXPECT_EQ(read.motion.position_scale, defaults.motion.position_scale);
  EXPECT_EQ(read.force_gain, defaults.force_gain);
  EXPECT_EQ(read.frame.device_axes, defaults.frame.device_axes);
  EXPECT_EQ(read.fixtures.limit_stiffness, defaults.fixtures.limit_stiffness);
  EXPECT_EQ(read.fixtures.guide, defaults.fixtures.guide);
  EXPECT_EQ(read.coupling.stiffness, defaults.coupling.stiffness);
  EXPECT_EQ(read.coupling.lateness, defaults.coupling.lateness);
  EXPECT_EQ(read.passivity.reserve, defaults.passivity.reserve);
  EXPECT_EQ(read.passivity.gate.damping_limit, defaults.passivity.gate.damping_limit);
  EXPECT_EQ(read.passivity.ripple.tolerance, defaults.passivity.ripple.tolerance);
  EXPECT_EQ(read.engagement.speed, defaults.engagement.speed);
  EXPECT_EQ(read.limits.rate, defaults.limits.rate);
}

TEST(HapticBridgeConfig, NamesWhatIsWrong) {
  const auto complaint = [](const std::string& text) {
    ConfigReader reader(YAML::Load(text), "test");
    HapticBridgeConfig::read(reader);
    try {
      reader.finish();
    } catch (const ConfigError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(complaint("{}"), "");
  for (const char* text :
       {"position_scale: 0", "force_source: guessed", "measured_share: 1.5", "device_axes: x y -z", "mode: speed",
        "force_rate_limit: 0", "passivity: {reserve: 0}", "passivity: {ripple: {memory: 0}}",
        "coupling: {stiffness: -1}", "fixtures: {guide: {axis: [0, 0, 0]}}", "fixtures: {workspace: {low: [1, 0, 0]}}",
        "tremor_filter: {cutoff: -1}", "engagement: {mode: jump}", "rate_mode: {dead_zone: -1}",
        "passivity: {damping: 1}"}) {
    const std::string said = complaint(text);
    const std::string line(text);
    EXPECT_FALSE(said.empty()) << text;
    EXPECT_NE(said.find(line.substr(0, line.find(':'))), std::string::npos) << text << ": " << said;
  }
}

}  // namespace
}  // namespace microinjection
