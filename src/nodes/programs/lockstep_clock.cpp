#include "nodes/lockstep_clock_node.h"
#include "nodes/runtime/run_node.h"

int main(int argc, char** argv) {
  return microinjection::runNode<microinjection::LockstepClockNode>(argc, argv, "lockstep_clock",
                                                                    microinjection::Priority::kOrdinary);
}
