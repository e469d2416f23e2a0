#include "nodes/runtime/run_node.h"
#include "nodes/visual_servo_node.h"

int main(int argc, char** argv) {
  return microinjection::runNode<microinjection::VisualServoNode>(argc, argv, "visual_servo",
                                                                  microinjection::Priority::kOrdinary);
}
