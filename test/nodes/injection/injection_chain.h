#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "action_client.h"
#include "cell_microinjection/CellState.h"
#include "cell_microinjection/InjectAction.h"
#include "cell_microinjection/InjectionStatus.h"
#include "cell_microinjection/InjectorState.h"
#include "cell_microinjection/OperatingState.h"
#include "nodes/runtime/conversions.h"
#include "virtual_session.h"

namespace microinjection {

/// A whole session whose controller moves the needle by itself, over a coarse live cell that is punctured early. The
/// test asks for injections, by words and by the action.
class InjectionChain {
 public:
  explicit InjectionChain(const std::vector<std::string>& overrides = {}, const std::string& scene = "injected_oocyte")
      : session(completed(overrides, scene)) {
    TestNode& world = session.world();
    world.hear<cell_microinjection::InjectionStatus>("controller/injection_state");
    world.hear<cell_microinjection::OperatingState>("controller/operating_state");
    world.hear<cell_microinjection::CellState>("cell/state");
    world.hear<cell_microinjection::InjectorState>("injector/state");
    auto& needle = world.hear<geometry_msgs::PoseStamped>("needle/measured_cp");
    world.publisher<cell_microinjection::StringStamped>("controller/state_command");
    session.start();
    // A real rig answers later.
    EXPECT_TRUE(session.until([&] { return needle.newest() && !needle.newest()->header.stamp.isZero(); }));
    session.run(0.05);
  }

  const cell_microinjection::InjectionStatus& status() {
    return newest<cell_microinjection::InjectionStatus>("controller/injection_state");
  }
  const cell_microinjection::CellState& cell() { return newest<cell_microinjection::CellState>("cell/state"); }
  const cell_microinjection::InjectorState& injector() {
    return newest<cell_microinjection::InjectorState>("injector/state");
  }
  Eigen::Vector3d needle() { return toVector(newest<geometry_msgs::PoseStamped>("needle/measured_cp").pose.position); }

  /// A word of a CRTK client, which has no stamp.
  void say(const std::string& word) {
    cell_microinjection::StringStamped message;
    message.string = word;
    session.world().say("controller/state_command", message);
  }
  /// Until the injection is in this state.
  bool reaches(const std::string& state) {
    const bool reached = session.until([&] { return status().state == state; }, 30);
    EXPECT_TRUE(reached) << state << " is not reached; the injection is in " << status();
    return reached;
  }

  /// Where the needle rests, once it does: an injection ends when its set-point is there.
  Eigen::Vector3d resting() {
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector3d before = needle();
      session.run(0.03);  // some of the rig's time constants, and of its reports
      if ((needle() - before).cwiseAbs().maxCoeff() < 0.02e-6) return needle();
    }
    ADD_FAILURE() << "the needle does not rest";
    return needle();
  }
  /// The needle is where it set out, the controller ready for the next injection.
  void expectOut(const Eigen::Vector3d& start) {
    const auto is_there = [&] { return (needle() - start).cwiseAbs().maxCoeff() < 0.1e-6; };
    EXPECT_TRUE(session.until(is_there, 0.03)) << needle().transpose() << " in place of " << start.transpose();
    EXPECT_TRUE(session.until([&] { return status().state == "idle"; }, 0.2)) << status();
    EXPECT_EQ(newest<cell_microinjection::OperatingState>("controller/operating_state").state, "ENABLED");
  }

  /// The states that it has gone through since the start, without idle.
  std::vector<std::string> passed() {
    std::vector<std::string> states;
    std::string last;
    for (const auto& message : statuses()) {
      if (message->state != last && message->state != "idle") states.push_back(message->state);
      last = message->state;
    }
    return states;
  }
  /// The states in which it has waited for a word.
  std::set<std::string> waited() {
    std::set<std::string> states;
    for (const auto& message : statuses()) {
      if (message->waits) states.insert(message->state);
    }
    return states;
  }

  VirtualSession session;

 private:
  static std::vector<std::string> completed(const std::vector<std::string>& overrides, const std::string& scene) {
    // The ways through the air are shorter than by config.
    const std::string motion = "overrides.injection_controller.motion.";
    std::vector<std::string> all = {std::string("hand.device:=none"),
                                    std::string("display.markers:=false"),
                                    std::string("model:=live"),
                                    "cell:=" + testFile("scenes/" + scene + ".yaml"),
                                    std::string("injection.start_when_enabled:=false"),
                                    motion + "stab_speed:=20e-6",
                                    motion + "approach_speed:=40e-6",
                                    motion + "retract_speed:=80e-6"};
    for (const std::string& argument : overrides) {
      const std::string key = argument.substr(0, argument.find(":=") + 2);
      all.erase(std::remove_if(all.begin(), all.end(), [&](const auto& usual) { return usual.rfind(key, 0) == 0; }),
                all.end());
    }
    all.insert(all.end(), overrides.begin(), overrides.end());
    return all;
  }
  template <typename Message>
  const Message& newest(const std::string& topic) {
    static const Message none;
    const Message* const message = session.world().hear<Message>(topic).newest();
    return message ? *message : none;
  }
  const std::vector<boost::shared_ptr<const cell_microinjection::InjectionStatus>>& statuses() {
    return session.world().hear<cell_microinjection::InjectionStatus>("controller/injection_state").all();
  }
};

/// A goal through one membrane, with a pulse.
inline cell_microinjection::InjectGoal punctureGoal() {
  cell_microinjection::InjectGoal goal;
  goal.puncture = true;
  goal.layers = 1;
  goal.depth = 15e-6;
  goal.margin = 2e-6;
  goal.hold_time = 0.1;
  goal.pressure = 20e3;
  goal.duration = 0.3;
  return goal;
}
/// A short one that leaves the cell whole.
inline cell_microinjection::InjectGoal indentationGoal() {
  cell_microinjection::InjectGoal goal = punctureGoal();
  goal.puncture = false;
  goal.depth = 2e-6;
  goal.hold_time = 0;
  return goal;
}

}  // namespace microinjection
