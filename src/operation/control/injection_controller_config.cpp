#include "operation/control/injection_controller.h"

namespace microinjection {

InjectionControllerConfig InjectionControllerConfig::read(ConfigReader& reader) {
  InjectionControllerConfig config;
  reader.choice("mode", config.mode, {"manual", "semi_automatic", "automatic"});
  reader.boolean("start_when_enabled", config.start_when_enabled);
  config.guards = GuardConfig::read(reader);
  ConfigReader detection = reader.section("detection");
  config.detection = DetectionConfig::read(detection);
  ConfigReader motion = reader.section("motion");
  config.motion = InjectionMotionConfig::read(motion);
  for (const auto& [key, speed] : {std::pair("approach_speed", config.motion.approach_speed),
                                   {"stab_speed", config.motion.stab_speed},
                                   {"retract_speed", config.motion.retract_speed}}) {
    if (speed > config.guards.speed_limit) motion.error(key, "must not be above speed_limit");
  }
  ConfigReader expectation = reader.section("expected_puncture");
  config.expectation.read(expectation);
  ConfigReader witness = reader.section("witness");
  config.witness.read(witness);
  ConfigReader goal = reader.section("goal");
  config.goal = InjectionGoal::read(goal);
  if (config.goal.depth > config.guards.depth_limit) goal.error("depth", "must not be above depth_limit");
  return config;
}

}  // namespace microinjection
