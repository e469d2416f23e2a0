#include "nodes/microscope_node.h"
#include "nodes/runtime/run_node.h"

int main(int argc, char** argv) {
  return microinjection::runNode<microinjection::MicroscopeNode>(argc, argv, "microscope",
                                                                 microinjection::Priority::kOrdinary);
}
