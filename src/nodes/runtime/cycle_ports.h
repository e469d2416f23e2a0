#pragma once

#include <memory>
#include <vector>

#include "nodes/runtime/ports.h"
#include "nodes/runtime/stall_monitor.h"

namespace microinjection {

/// The topics of a cycle.
struct CyclePorts {
  std::vector<std::unique_ptr<InputPort>> inputs;
  std::vector<std::unique_ptr<OutputPort>> outputs;
  StallMonitor stalls;
};

}  // namespace microinjection
