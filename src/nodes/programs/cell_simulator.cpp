#include "nodes/cell_simulator_node.h"
#include "nodes/runtime/run_node.h"

int main(int argc, char** argv) {
  return microinjection::runNode<microinjection::CellSimulatorNode>(argc, argv, "cell_simulator");
}
