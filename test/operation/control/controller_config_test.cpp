#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "base/errors.h"
#include "operation/control/injection_controller.h"

namespace microinjection {
namespace {

InjectionControllerConfig readConfig(const YAML::Node& map) {
  ConfigReader reader(map, "test");
  const InjectionControllerConfig config = InjectionControllerConfig::read(reader);
  reader.finish();
  return config;
}

YAML::Node shipped() {
  YAML::Node map = loadYamlMap(MICROINJECTION_SOURCE_DIR "/config/injection_controller.yaml");
  for (const char* of_the_node : {"rate", "input_timeout", "force_source", "injector"}) map.remove(of_the_node);
  return map;
}

std::string refusal(const YAML::Node& map) {
  try {
    readConfig(map);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(InjectionControllerConfig, TheShippedFileIsReadKeyByKey) {
  YAML::Node map = shipped();
  const InjectionControllerConfig config = readConfig(map);
  EXPECT_EQ(config.mode, "manual");
  EXPECT_TRUE(config.goal.puncture);
  EXPECT_DOUBLE_EQ(config.goal.depth, 48e-6);
  for (const char* section : {"detection", "motion", "goal"}) {
    for (const auto& entry : map[section]) {
      if (entry.second.IsMap()) continue;
      YAML::Node changed = YAML::Clone(map);
      changed[section][entry.first.as<std::string>()] = "nonsense";
      const std::string key = std::string(section) + "/" + entry.first.as<std::string>();
      EXPECT_NE(refusal(changed).find(key + " = nonsense"), std::string::npos) << key << ": " << refusal(changed);
    }
  }
}

TEST(InjectionControllerConfig, WhatDoesNotFitTogetherIsRefused) {
  YAML::Node fast = shipped();
  fast["motion"]["stab_speed"] = 201e-6;
  EXPECT_NE(refusal(fast).find("motion/stab_speed"), std::string::npos) << refusal(fast);
  YAML::Node slow = shipped();
  slow["motion"]["stab_speed"] = 4e-6;
  EXPECT_NE(refusal(slow).find("must not be below indent_speed"), std::string::npos);
  YAML::Node deep = shipped();
  deep["goal"]["depth"] = 51e-6;
  EXPECT_NE(refusal(deep).find("must not be above depth_limit"), std::string::npos);
  YAML::Node old = shipped();
  old["source"] = "teleop";
  EXPECT_NE(refusal(old).find("source"), std::string::npos);
}

/// A number of a goal is allowed or refused, by its key, in a file as on a topic.
TEST(InjectionGoal, NumbersThatCannotBeMeantAreRefusedByName) {
  struct Case {
    std::string key;
    double good, bad;
    std::function<void(InjectionGoal&, double)> put;
  };
  const Case cases[] = {
      {"layers", 10, 11, [](InjectionGoal& goal, double value) { goal.layers = static_cast<int>(value); }},
      {"layers", 1, 0, [](InjectionGoal& goal, double value) { goal.layers = static_cast<int>(value); }},
      {"depth", 1e-3, 1.1e-3, [](InjectionGoal& goal, double value) { goal.depth = value; }},
      {"depth", 1e-9, 0, [](InjectionGoal& goal, double value) { goal.depth = value; }},
      {"margin", 1e-3, 1e9, [](InjectionGoal& goal, double value) { goal.margin = value; }},
      {"margin", 0, -1e-9, [](InjectionGoal& goal, double value) { goal.margin = value; }},
      {"hold_time", 600, 1e300, [](InjectionGoal& goal, double value) { goal.hold_time = value; }},
      {"hold_time", 0, -1, [](InjectionGoal& goal, double value) { goal.hold_time = value; }},
      {"pulse/pressure", 1e6, 1e300, [](InjectionGoal& goal, double value) { goal.pulse.pressure = value; }},
      {"pulse/pressure", 0, -1, [](InjectionGoal& goal, double value) { goal.pulse.pressure = value; }},
      {"pulse/duration", 60, 61, [](InjectionGoal& goal, double value) { goal.pulse.duration = value; }},
      {"pulse/volume", 1e-9, 1.1e-9, [](InjectionGoal& goal, double value) { goal.pulse.volume = value; }},
      {"pulse/volume", 0, -1e-15, [](InjectionGoal& goal, double value) { goal.pulse.volume = value; }},
  };
  const auto inFile = [](const std::string& key, double value) {
    YAML::Node map = shipped();
    map["depth_limit"] = 1;
    const std::size_t slash = key.find('/');
    if (slash == std::string::npos) map["goal"][key] = value;
    if (slash != std::string::npos) map["goal"][key.substr(0, slash)][key.substr(slash + 1)] = value;
    return refusal(map);
  };
  for (const Case& one : cases) {
    InjectionGoal goal;
    one.put(goal, one.good);
    EXPECT_EQ(goal.problems(), "") << one.key;
    EXPECT_EQ(inFile(one.key, one.good), "") << one.key;
    for (const double bad : {one.bad, std::numeric_limits<double>::quiet_NaN(), HUGE_VAL, -HUGE_VAL}) {
      if (one.key == "layers" && !std::isfinite(bad)) continue;
      one.put(goal, bad);
      EXPECT_EQ(goal.problems().rfind(one.key + " = ", 0), 0u) << goal.problems();
      EXPECT_NE(goal.problems().find(", allowed "), std::string::npos) << goal.problems();
      EXPECT_NE(inFile(one.key, bad).find("goal/" + one.key), std::string::npos) << one.key << " = " << bad;
    }
  }
}

}  // namespace
}  // namespace microinjection
