#include "nodes/haptic/haptic_device_node.h"
#include "nodes/runtime/run_node.h"

namespace {

/// Started by the operator in a terminal, with the parameters of a session or without any.
struct KeyboardHand : microinjection::HapticDeviceNode {
  explicit KeyboardHand(microinjection::Bus& bus) : HapticDeviceNode(bus, "keyboard") {}
};

}  // namespace

int main(int argc, char** argv) {
  using namespace microinjection;
  return runNode<KeyboardHand>(argc, argv, "keyboard_hand", Priority::kRealTime, ShutdownMode::kInGoodOrder);
}
