#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <string>

#include "base/errors.h"
#include "control/injection_controller.h"

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
  for (const char* of_the_node : {"rate", "input_timeout", "force_source", "injector", "commands_in_lockstep"})
    map.remove(of_the_node);
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

}  // namespace
}  // namespace microinjection
