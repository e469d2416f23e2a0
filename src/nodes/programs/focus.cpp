#include "nodes/focus_node.h"
#include "nodes/runtime/run_node.h"

int main(int argc, char** argv) {
  return microinjection::runNode<microinjection::FocusNode>(argc, argv, "focus", microinjection::Priority::kOrdinary);
}
