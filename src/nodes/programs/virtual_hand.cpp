#include "nodes/runtime/run_node.h"
#include "nodes/virtual_hand_node.h"

int main(int argc, char** argv) {
  return microinjection::runNode<microinjection::VirtualHandNode>(argc, argv, "virtual_hand");
}
