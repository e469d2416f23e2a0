#include "nodes/link_emulator_node.h"
#include "nodes/runtime/run_node.h"

int main(int argc, char** argv) {
  return microinjection::runNode<microinjection::LinkEmulatorNode>(argc, argv, "link_emulator");
}
