#pragma once

#include <ros/ros.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <string>

#include "base/console_relay.h"
#include "nodes/bus/ending.h"
#include "nodes/bus/namesake.h"
#include "nodes/bus/ros_bus.h"
#include "nodes/runtime/parameter_texts.h"
#include "nodes/runtime/real_time.h"

namespace microinjection {

/// The `main` of a node: starts ROS, constructs Node(bus) on a RosBus and runs the bus until shutdown. A
/// node with wrong parameters does not start: exceptions of its constructor are logged and the exit
/// status is 1. `priority` applies where the system allows it. With ShutdownMode::kInGoodOrder the first
/// signal only requests the end (ending.h).
enum class ShutdownMode { kAtOnce, kInGoodOrder };
template <typename Node>
int runNode(int argc, char** argv, const std::string& name, Priority priority = Priority::kRealTime,
            ShutdownMode ending = ShutdownMode::kAtOnce) {
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "--help" || std::string(argv[i]) == "-h") {
      const std::string parameters = parameterText(name);
      std::printf("%s", Node::kHelp);
      if (!parameters.empty()) std::printf("\nParameters (private), as a session sets them:\n\n%s", parameters.c_str());
      return 0;
    }
  }
  const ConsoleRelay console;  // before any thread starts: a stopped terminal must not stop a loop
  ros::init(argc, argv, name, ending == ShutdownMode::kInGoodOrder ? ros::init_options::NoSigintHandler : 0);
  // roscpp handles only SIGINT. The other signals, too, must stop a device before the end.
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) std::signal(number, [](int) { ros::requestShutdown(); });
  if (const std::string other = livingNamesake(); !other.empty()) {
    std::fprintf(stderr,
                 "%s: a node of this name runs already (%s). End that session first, or give this one a master of its "
                 "own (ROS_MASTER_URI).\n",
                 ros::this_node::getName().c_str(), other.c_str());
    return 1;
  }
  if (bool simulated = false; ros::param::get("/use_sim_time", simulated) && simulated) {
    std::fprintf(stderr,
                 "%s: the parameter /use_sim_time is true: time would stand, and so would this node, until somebody "
                 "publishes /clock. rosparam set /use_sim_time false, or start a session, which does.\n",
                 ros::this_node::getName().c_str());
    return 1;
  }
  prefer(priority);
  if (ending == ShutdownMode::kInGoodOrder) endInGoodOrder();
  // The handle outlives the try block: the end of the last one shuts ROS and its log down.
  const ros::NodeHandle handle;
  try {
    RosBus bus;
    Node node(bus);
    bus.run();
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(error.what());
    return 1;
  }
  return 0;
}

}  // namespace microinjection
