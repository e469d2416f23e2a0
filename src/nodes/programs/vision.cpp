#include "nodes/runtime/run_node.h"
#include "nodes/vision_node.h"

int main(int argc, char** argv) {
  return microinjection::runNode<microinjection::VisionNode>(argc, argv, "vision", microinjection::Priority::kOrdinary);
}
