#include "nodes/haptic_bridge_node.h"
#include "nodes/run_node.h"

int main(int argc, char** argv) {
  return microinjection::runNode<microinjection::HapticBridgeNode>(argc, argv, "haptic_bridge");
}
