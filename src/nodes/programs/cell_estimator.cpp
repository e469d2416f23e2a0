#include "nodes/cell_estimator_node.h"
#include "nodes/runtime/run_node.h"

int main(int argc, char** argv) {
  return microinjection::runNode<microinjection::CellEstimatorNode>(argc, argv, "cell_estimator");
}
