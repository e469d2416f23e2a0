#include "benchmark/emulated_haptic/emulated_haptic_node.h"
#include "nodes/runtime/run_node.h"

int main(int argc, char** argv) {
  return microinjection::runNode<microinjection::EmulatedHapticNode>(argc, argv, "emulated_haptic");
}
