#pragma once

#include <string>
#include <vector>

#include "cell_microinjection/LoopState.h"
#include "cell_microinjection/OperatingState.h"
#include "fault_session.h"
#include "led_hand.h"

namespace microinjection {

/// All nodes of a loop with sensor and injector. The test is the hand; the needle follows it from now on.
class LedSession : public FaultSession {
 public:
  LedSession()
      : FaultSession({"cell:=" + testFile("scenes/coarse_oocyte.yaml"), "model:=live", "hand.device:=external",
                      "hand.require_operator:=false", "display.markers:=false"}) {
    session().world().hear<cell_microinjection::OperatingState>("controller/operating_state");
    session().world().hear<cell_microinjection::OperatingState>("needle/operating_state");
    session().world().hear<cell_microinjection::LoopState>("controller/loop_state");
    session().world().hear<cell_microinjection::LoopState>("haptic/loop_state");
    for (const char* node : kNodes) session().add(node, "{diagnostic_period: 0.1}");
    session().run(0.5);
  }

  LedHand& hand() { return hand_; }
  std::string state(const std::string& topic) {
    const auto* state = session().world().hear<cell_microinjection::OperatingState>(topic).newest();
    return state ? state->state : "";
  }
  void expectEnabled() {
    EXPECT_EQ(state("controller/operating_state"), "ENABLED");
    EXPECT_EQ(state("needle/operating_state"), "ENABLED");
  }
  /// Why a node has held since `time` (s); empty: it has followed.
  std::string holdReasons(const std::string& topic, double time) {
    std::string reasons;
    for (const auto& message : session().world().hear<cell_microinjection::LoopState>(topic).all()) {
      if (message->header.stamp.toSec() > time) reasons += message->hold_reason;
    }
    return reasons;
  }

  static constexpr const char* kNodes[] = {"micromanipulator", "force_sensor",         "cell_simulator",
                                           "injector",         "injection_controller", "haptic_bridge"};

 private:
  LedHand hand_{session()};
};

}  // namespace microinjection
