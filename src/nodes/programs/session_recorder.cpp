#include "nodes/runtime/run_node.h"
#include "nodes/session_recorder_node.h"

int main(int argc, char** argv) {
  return microinjection::runNode<microinjection::SessionRecorderNode>(argc, argv, "session_recorder",
                                                                      microinjection::Priority::kPrompt);
}
