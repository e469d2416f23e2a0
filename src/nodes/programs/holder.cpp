#include "nodes/holder_node.h"
#include "nodes/runtime/run_node.h"

int main(int argc, char** argv) {
  return microinjection::runNode<microinjection::HolderNode>(argc, argv, "holder", microinjection::Priority::kPrompt);
}
