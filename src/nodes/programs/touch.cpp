#include "nodes/runtime/run_node.h"
#include "nodes/touch_node.h"

int main(int argc, char** argv) {
  return microinjection::runNode<microinjection::TouchNode>(argc, argv, "touch", microinjection::Priority::kOrdinary);
}
