#include "nodes/executive/simulation.h"

#include <gtest/gtest.h>

#include <set>

#include "base/errors.h"
#include "nodes/session/recorded_session.h"
#include "virtual_session.h"

namespace microinjection {
namespace {

class SimulationTest : public testing::Test {
 protected:
  /// A session of a virtual hand over a cell of a family, which is recorded in a folder of this name.
  Session session(const std::string& name, const std::vector<Waypoint>& way = kHandPath,
                  std::vector<std::string> overrides = {}) const {
    overrides.push_back("hand.motion:=" + writeMotion(folders_.path() / (name + ".yaml"), way));
    overrides.push_back("record.folder:=" + (folders_.path() / name).string());
    return load(overrides);
  }
  static Session load(const std::vector<std::string>& overrides) {
    return Session::load("default", overrides, MICROINJECTION_SOURCE_DIR);
  }
  std::string file(const std::string& session, const std::string& name) const {
    return readFile(folders_.path() / session / name);
  }
  static std::string errorOf(const std::function<void()>& call) {
    try {
      call();
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  }
  /// The hand's way with its first parts, as far as this phase.
  static std::vector<Waypoint> untilPhase(const std::string& last) {
    auto way = kHandPath;
    while (!way.empty() && way.back().phase != last) way.pop_back();
    return way;
  }

  UserFolders folders_;
};

TEST_F(SimulationTest, TwoRunsOfASessionWriteTheSameBytes) {
  for (const char* name : {"first", "second"}) {
    const SimulationResult result = simulate(session(name), {});
    EXPECT_TRUE(result.done);
    EXPECT_EQ(result.failures, std::vector<std::string>());
    EXPECT_EQ(result.warnings, std::vector<std::string>());
  }
  for (const char* name : {"force_depth.csv", "summary.yaml", "session.bag"}) {
    EXPECT_TRUE(file("first", name) == file("second", name)) << name << " differs";
  }
  const auto rows = CsvRows(file("first", "force_depth.csv")).all();
  std::set<std::string> states;
  for (const auto& row : rows) states.insert(row.at("injection_state"));
  EXPECT_EQ(states.count("indent"), 1u) << "a session that tells something";
}

TEST_F(SimulationTest, ASessionEndsHalfASecondAfterItsHand) {
  const SimulationResult result = simulate(session("whole", {{"approach", 0.5, -1e-3, false}}), {});
  EXPECT_TRUE(result.done);
  // The hand rests for 1 s before its way.
  EXPECT_NEAR(result.simulated, 1 + 0.5 + 0.5, 0.01);
  EXPECT_EQ(result.outcome, "none");
}

TEST_F(SimulationTest, AnAutomaticInjectionEndsTheSession) {
  const SimulationResult result = simulate(load({"hand.device:=none"}), {});
  EXPECT_TRUE(result.done);
  EXPECT_EQ(result.outcome, "injected");
  EXPECT_EQ(result.failures, std::vector<std::string>());
  EXPECT_EQ(result.warnings, std::vector<std::string>());
}

TEST_F(SimulationTest, ADurationEndsItWithoutAWordOfTheHand) {
  SimulationConfig config;
  config.duration = 2;
  const SimulationResult result = simulate(session("short"), config);
  EXPECT_TRUE(result.done);
  EXPECT_NEAR(result.simulated, 2, 1e-9);
  EXPECT_EQ(result.warnings, std::vector<std::string>());
  const auto rows = CsvRows(file("short", "force_depth.csv")).all();
  EXPECT_NEAR(toNumber(rows.back().at("time_s")), 2, 0.011);
  // Longer than the hand's way.
  config.duration = 3;
  EXPECT_NEAR(simulate(session("long", {{"approach", 0.5, -1e-3, false}}), config).simulated, 3, 1e-9);
}

TEST_F(SimulationTest, WhatIsNotDoneWithinTheLimitIsTold) {
  SimulationConfig config;
  config.limit = 1.5;
  const SimulationResult result = simulate(session("limited"), config);
  EXPECT_FALSE(result.done);
  EXPECT_EQ(result.warnings, std::vector<std::string>{"neither the hand nor the injection was done within 1.5 s"});
}

TEST_F(SimulationTest, AHandThatEndsBeforeTheNeedleIsOutIsTold) {
  const SimulationResult result = simulate(session("inside", untilPhase("hold")), {});
  EXPECT_TRUE(result.done);
  ASSERT_EQ(result.warnings.size(), 1u);
  EXPECT_EQ(result.warnings[0].find("the session ends while the needle is in the cell, "), 0u) << result.warnings[0];
  const double depth = std::stod(result.warnings[0].substr(result.warnings[0].find(", ") + 2));  // um
  EXPECT_GT(depth, 2.5);
  EXPECT_LT(depth, 4.1);
}

TEST_F(SimulationTest, ANodeThatDoesNotStartIsNamed) {
  const Session wrong = session("wrong", kHandPath, {"overrides:={haptic_bridge: {position_scale: 0}}"});
  const std::string error = errorOf([&] { simulate(wrong, {}); });
  EXPECT_NE(error.find("node haptic_bridge: "), std::string::npos) << error;
  EXPECT_NE(error.find("position_scale = 0"), std::string::npos) << error;
}

TEST_F(SimulationTest, ANodeThatEndsByAnErrorIsNamedAndEndsTheSession) {
  const std::vector<Waypoint> way = {{"approach", 0.5, -1e-3, false}};
  std::filesystem::create_directories(folders_.path() / "failing" / "summary.yaml");  // in the place of the file
  SimulationConfig config;
  config.duration = 5;
  // The recorder ends with the hand, in a step.
  const SimulationResult result = simulate(session("failing", way, {"record.end_when_done:=true"}), config);
  ASSERT_EQ(result.failures.size(), 1u);
  EXPECT_EQ(result.failures[0].find("session_recorder: "), 0u) << result.failures[0];
  EXPECT_NE(result.failures[0].find("summary.yaml: cannot be written"), std::string::npos) << result.failures[0];
  EXPECT_LT(result.simulated, 1 + 0.5 + 0.1);
  EXPECT_EQ(file("failing", "force_depth.csv").empty(), false);
}

/// Of a session that nobody has started, everything at once.
TEST_F(SimulationTest, AllThatNeedsADeviceADisplayOrAPersonIsRefusedByName) {
  Session session = load({});
  session.rig.name = "zaber";
  session.sensor.source = "serial";
  session.injector = "femtojet";
  session.hand.device = "keyboard";
  session.hand.wait_for_go = true;
  session.injection.mode = "semi_automatic";
  session.camera.source = "device";
  session.display.rviz = true;
  session.display.console = "inject";
  session.places.of["rig/name"] = "lab.yaml, line 3";
  const std::string error = errorOf([&] { requireSimulable(session); });
  for (const char* line :
       {"lab.yaml, line 3: rig/name = zaber: ", ": sensor/source = serial: ", ": injector = femtojet: ",
        ": hand/device = keyboard: ", ": hand/wait_for_go = true: ", ": injection/mode = semi_automatic: ",
        ": camera/source = device: ", ": display/rviz = true: ", ": display/console = inject: "}) {
    EXPECT_NE(error.find(line), std::string::npos) << error << " has no " << line;
  }
  EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 8);
  EXPECT_EQ(errorOf([&] { simulate(session, {}); }), error);
}

TEST_F(SimulationTest, WhatIsSimulatedOrEmulatedIsTaken) {
  for (const std::vector<std::string>& overrides : std::vector<std::vector<std::string>>{
           {},
           {"hand.device:=none"},
           {"rig.name:=emulated_zaber", "injector:=emulated_voltage", "camera.source:=sim"},
           {"sensor.source:=none", "injector:=none", "camera.source:=folder",
            "camera.path:=" + folders_.path().string()}}) {
    EXPECT_EQ(errorOf([&] { requireSimulable(load(overrides)); }), "");
  }
}

TEST_F(SimulationTest, ASensorOfAnotherNodeIsRefusedToo) {
  const std::string error = errorOf([&] { requireSimulable(load({"sensor.source:=topic", "camera.source:=topic"})); });
  EXPECT_NE(error.find("sensor/source = topic"), std::string::npos) << error;
  EXPECT_NE(error.find("camera/source = topic"), std::string::npos) << error;
}

TEST_F(SimulationTest, WhatNobodyWouldStartIsRefused) {
  for (const std::string& key : {"auto_enable", "start_when_enabled"}) {
    const std::string error = errorOf([&] {
      requireSimulable(load({"hand.device:=none", "injection." + key + ":=false"}));
    });
    EXPECT_NE(error.find("injection/" + key + " = false"), std::string::npos) << error;
  }
  EXPECT_NE(errorOf([&] { requireSimulable(load({"injection.auto_enable:=false"})); }), "");
  EXPECT_EQ(errorOf([&] { requireSimulable(load({"injection.start_when_enabled:=false"})); }), "") << "the hand leads";
}

}  // namespace
}  // namespace microinjection
