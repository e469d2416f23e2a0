#include "nodes/haptic_bridge_node.h"
#include "nodes/runtime/run_node.h"

int main(int argc, char** argv) {
  using namespace microinjection;
  return runNode<HapticBridgeNode>(argc, argv, "haptic_bridge", Priority::kRealTime, ShutdownMode::kInGoodOrder);
}
