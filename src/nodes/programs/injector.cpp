#include "nodes/injector_node.h"
#include "nodes/runtime/run_node.h"

int main(int argc, char** argv) {
  return microinjection::runNode<microinjection::InjectorNode>(argc, argv, "injector",
                                                               microinjection::Priority::kPrompt);
}
