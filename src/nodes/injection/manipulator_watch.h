#pragma once

#include <string>

#include "nodes/bus/bus.h"

namespace microinjection {

/// Whether the rig follows the stream of set-points. A rig that tells neither is taken to follow.
///
/// In: /needle/operating_state (OperatingState), /needle/loop_state (LoopState)
class ManipulatorWatch {
 public:
  explicit ManipulatorWatch(Bus& bus);

  /// Why the rig does not follow, or did not at some moment since the last call; empty: it does.
  std::string takeHold();

 private:
  std::string state_, loop_;  ///< reasons, as told last
  std::string missed_;        ///< a reason since the last call
  Subscription operating_states_, loop_states_;
};

}  // namespace microinjection
