#pragma once

#include <gtest/gtest.h>

#include <string>

#include "operation/control/spring_rig.h"

namespace microinjection {

/// An automatic injection of a SpringRig.
class InjectionFixture : public testing::Test {
 protected:
  InjectionFixture() {
    config_.mode = "automatic";
    config_.goal.depth = 30e-6;
    config_.goal.pulse.duration = 0.3;
    config_.motion.stop_time = 5e-3;
  }

  void enable() {
    controller_ = InjectionController(config_);
    controller_.command("enable");
    rig_.step(controller_);
  }

  /// Steps until that state; false when it does not come.
  bool reach(InjectionState state) {
    for (int i = 0; i < 100000; ++i) {
      if (controller_.injection() == state) return true;
      rig_.step(controller_);
    }
    return false;
  }

  void steps(int count) {
    for (int i = 0; i < count; ++i) rig_.step(controller_);
  }

  /// The needle does not move any more, or is out of the cell.
  void expectSafe(const std::string& where) {
    rig_.run(controller_);
    steps(200);
    const Eigen::Vector3d before = rig_.tip;
    steps(100);
    EXPECT_LT((rig_.tip - before).norm(), 1e-9) << where;
    EXPECT_FALSE(controller_.pulse()) << where;
    EXPECT_FALSE(controller_.running()) << where;
  }

  InjectionControllerConfig config_;
  InjectionController controller_{config_};
  SpringRig rig_;
};

}  // namespace microinjection
