#include "nodes/image_recorder_node.h"
#include "nodes/runtime/run_node.h"

int main(int argc, char** argv) {
  return microinjection::runNode<microinjection::ImageRecorderNode>(argc, argv, "image_recorder",
                                                                    microinjection::Priority::kOrdinary);
}
