#include "nodes/readiness_node.h"
#include "nodes/runtime/run_node.h"

int main(int argc, char** argv) {
  return microinjection::runNode<microinjection::ReadinessNode>(argc, argv, "readiness");
}
