#include "nodes/camera_node.h"
#include "nodes/runtime/run_node.h"

int main(int argc, char** argv) {
  return microinjection::runNode<microinjection::CameraNode>(argc, argv, "camera", microinjection::Priority::kOrdinary);
}
