// Bridge, device and watchdog take every file of config/haptic.

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <set>

#include "base/errors.h"
#include "nodes/haptic/haptic_device_node.h"
#include "virtual_session.h"

namespace microinjection {
namespace {

std::string hapticFile(const std::string& name) { return testFile("../../config/haptic/" + name + ".yaml"); }

std::vector<std::string> hapticNames() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(testFile("../../config/haptic")))
    names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

TEST(HapticConfig, ThereIsAFileForEachDevice) { EXPECT_GE(hapticNames().size(), 10U); }

class HapticConfigTest : public testing::TestWithParam<std::string> {};

TEST_P(HapticConfigTest, ItsNodesTakeTheFileAndEndInGoodOrder) {
  const std::set<std::string> known{"haptic_bridge", "haptic_device", "keyboard_hand", "force_watchdog"};
  for (const auto& section : YAML::LoadFile(hapticFile(GetParam())))
    EXPECT_EQ(known.count(section.first.as<std::string>()), 1U) << section.first;
  VirtualSession session({"hand.device:=" + GetParam()});
  const SessionPlan live = planOf(session.session(), SessionClock::kWall);  // has the watchdog, too
  const auto& forces = session.world().hear<geometry_msgs::WrenchStamped>("haptic/servo_cf");
  std::vector<std::string> nodes;
  for (const char* name : {"haptic_bridge", "haptic_device", "force_watchdog"}) {
    const NodePlan* const node = live.node(name);
    if (!node) continue;
    session.add(name, node->program, node->parameters);
    nodes.push_back(name);
  }
  session.run(0.1);
  for (const std::string& name : nodes) {
    EXPECT_TRUE(session.executive().runs(name)) << name;
    session.executive().end(name);
  }
  EXPECT_TRUE(session.executive().failures().empty());
  const std::size_t before = forces.count();
  session.run(2e-3);
  EXPECT_GE(forces.count(), before + 5) << "the bridge's last words are zero force";
}

INSTANTIATE_TEST_SUITE_P(Files, HapticConfigTest, testing::ValuesIn(hapticNames()),
                         [](const auto& name) { return name.param; });

/// Its terminal is what it asks for after its parameters.
TEST(HapticConfig, TheKeyboardTakesItsFile) {
  ASSERT_TRUE(std::freopen("/dev/null", "r", stdin));
  Executive executive;
  const YAML::Node parameters = YAML::LoadFile(hapticFile("keyboard"))["keyboard_hand"];
  try {
    executive.add(
        "keyboard_hand", [](Bus& bus) { return std::make_shared<HapticDeviceNode>(bus, "keyboard"); }, parameters);
    FAIL() << "it has no terminal here";
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("needs a terminal"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace microinjection
