#include "nodes/calibration_node.h"
#include "nodes/runtime/run_node.h"

int main(int argc, char** argv) {
  return microinjection::runNode<microinjection::CalibrationNode>(argc, argv, "calibration",
                                                                  microinjection::Priority::kOrdinary);
}
