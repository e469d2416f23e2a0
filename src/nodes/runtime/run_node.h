#pragma once

#include <ros/ros.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <string>

#include "base/console_relay.h"
#include "nodes/runtime/ending.h"
#include "nodes/runtime/lockstep.h"
#include "nodes/runtime/real_time.h"

namespace microinjection {

/// The whole `main` of a node: starts ROS, constructs Node(node, private_node) and runs it until shutdown. A node whose
/// parameters are wrong must not come alive: what its constructor throws is logged and the exit status is 1. Live,
/// nodes of the 1 kHz chain run in real time where the system allows it, those that hear every message of it promptly.
/// With ShutdownMode::kInGoodOrder it is asked to end (see ending.h) instead of being ended.
enum class ShutdownMode { kAtOnce, kInGoodOrder };
template <typename Node>
int runNode(int argc, char** argv, const std::string& name, Priority priority = Priority::kRealTime,
            ShutdownMode ending = ShutdownMode::kAtOnce) {
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "--help" || std::string(argv[i]) == "-h") {
      std::printf("%s", Node::kHelp);
      return 0;
    }
  }
  const ConsoleRelay console;  // before there are threads: a stopped terminal must not stop a loop
  ros::init(argc, argv, name, ending == ShutdownMode::kInGoodOrder ? ros::init_options::NoSigintHandler : 0);
  // roscpp hears SIGINT only: at the others, too, a device is told to stop before the end.
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) std::signal(number, [](int) { ros::requestShutdown(); });
  if (!takesPartInLockstep()) {
    prefer(priority);
    // In lock step a node that waits for its tick could not speak any more.
    if (ending == ShutdownMode::kInGoodOrder) endInGoodOrder();
  }
  // These outlive the try block: the end of the last handle shuts ROS down, and its log with it.
  const ros::NodeHandle node_handle, private_node_handle("~");
  try {
    Node node(node_handle, private_node_handle);
    node.run();
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(error.what());
    return 1;
  }
  return 0;
}

}  // namespace microinjection
