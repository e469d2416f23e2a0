#include "nodes/runtime/run_node.h"
#include "nodes/teleoperation_follower_node.h"

int main(int argc, char** argv) {
  return microinjection::runNode<microinjection::TeleoperationFollowerNode>(argc, argv, "teleoperation_follower");
}
