#include "nodes/injection_controller_node.h"
#include "nodes/runtime/run_node.h"

int main(int argc, char** argv) {
  return microinjection::runNode<microinjection::InjectionControllerNode>(argc, argv, "injection_controller");
}
