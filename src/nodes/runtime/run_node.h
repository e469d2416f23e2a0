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

/// What the first SIGINT, SIGTERM or `rosnode kill` does to a node. With kInGoodOrder it only requests the end, so
/// that the node can still publish: zero force for a haptic driver that would go on rendering the last one. A second
/// one ends the node at once (nodes/bus/ending.h).
enum class ShutdownMode { kAtOnce, kInGoodOrder };

/// The `main` of a live node: starts ROS, constructs Node(bus) on a RosBus, and runs the bus until shutdown.
///
///     --help? | ConsoleRelay | ros::init, signals | namesake? | /use_sim_time? | priority | Node(bus) | bus.run()
///        0                                              1              1                        1           1
///
/// The second line has the exit status of what ends the program there. The programs of all nodes share this one
/// function, because the order matters and each step is easily forgotten in one of them:
///
/// - The output goes through a ConsoleRelay, because a terminal that is stopped (Ctrl-S, a hung ssh) would stop the
///   loop in its next write.
/// - SIGTERM and SIGHUP end a node as SIGINT does, because roscpp handles only SIGINT and a device must be stopped
///   first.
/// - A node does not start beside a living namesake. ROS would end the older one, and with a second session on one
///   master that is the node that moves a needle.
/// - A node does not start with /use_sim_time, because it would stand still until somebody publishes /clock.
/// - A node with wrong parameters does not start: what its constructor throws is logged, and the exit status is 1. An
///   exception that leaves the bus ends the node in the same way.
///
/// @param name  of the program: the node's name, unless remapped, and that of its file in config/ for --help
/// @param priority  applies where the system allows it (real_time.h)
/// @tparam Node  has a constructor of a Bus and the text kHelp
/// @returns the exit status
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
