#include "nodes/display_node.h"
#include "nodes/runtime/run_node.h"

int main(int argc, char** argv) {
  return microinjection::runNode<microinjection::DisplayNode>(argc, argv, "display",
                                                              microinjection::Priority::kOrdinary);
}
