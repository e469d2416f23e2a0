#include "nodes/haptic/haptic_device_node.h"
#include "nodes/runtime/run_node.h"

int main(int argc, char** argv) {
  using namespace microinjection;
  return runNode<HapticDeviceNode>(argc, argv, "haptic_device", Priority::kRealTime, ShutdownMode::kInGoodOrder);
}
