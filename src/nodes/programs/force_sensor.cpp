#include "nodes/force_sensor_node.h"
#include "nodes/runtime/run_node.h"

int main(int argc, char** argv) {
  return microinjection::runNode<microinjection::ForceSensorNode>(argc, argv, "force_sensor",
                                                                  microinjection::Priority::kPrompt);
}
