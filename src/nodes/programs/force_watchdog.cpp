#include "nodes/force_watchdog_node.h"
#include "nodes/runtime/run_node.h"

int main(int argc, char** argv) {
  return microinjection::runNode<microinjection::ForceWatchdogNode>(argc, argv, "force_watchdog");
}
