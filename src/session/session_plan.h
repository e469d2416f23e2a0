#pragma once

#include <yaml-cpp/yaml.h>

#include <array>
#include <map>
#include <string>
#include <vector>

#include "session/session.h"

namespace microinjection {

/// A node of the session.
struct NodePlan {
  std::string name;                           ///< without namespace
  std::string program;                        ///< its type: micromanipulator, cell_simulator, ...
  YAML::Node parameters;                      ///< all private ones, complete
  std::map<std::string, std::string> remaps;  ///< from, to
  int nice = 0;                               ///< 0 of the nodes that control
  bool required = false;                      ///< the session ends with it
  bool respawn = false;                       ///< it is started again when it ends
};

/// A frame that does not move.
struct StaticFrame {
  std::string name;  ///< of the node that publishes it
  std::string parent, child;
  std::array<double, 6> place = {};  ///< x y z (m) yaw pitch roll (rad) of the child in the parent
};

/// A process that is no node of ours. Only a live session has it.
struct ForeignProcess {
  std::string name, package, program;
  std::vector<std::string> arguments;
  std::string prefix;  ///< of its command
  std::map<std::string, std::string> environment, remaps;
  std::string view;  ///< of rviz: its configuration, which becomes a file that follows the arguments
};

/// What runs in a session: every node with all of its parameters, the frames and the processes of others. planOf()
/// makes it of a Session, whoever is going to run it:
///
///     config/NODE.yaml, session's keys, device's file, fit to the cell, overrides: each over the ones before
///                                         |
///     Session ---------> planOf() --> SessionPlan --> session.launch: a process for each      (SessionClock::kWall)
///                                                 --> Executive: all in one process           (SessionClock::kVirtual)
///
/// Launch files could decide the same with `if` and `eval`. But then what takes part, and with which parameters,
/// would be known to roslaunch alone; a session on virtual time and a test would need a second description, and
/// nothing would keep the two alike. A plan is plain data instead: tests look into it, the program `session` writes
/// it as a launch file (session/launch_file.h), and both ways of running start from the same one. It has the
/// parameters of config/, too, so that a plan shows what each node gets.
struct SessionPlan {
  std::vector<NodePlan> nodes;  ///< in the order of their start
  YAML::Node parameters;        ///< global ones, by name without the first slash: robot_description
  std::vector<StaticFrame> frames;
  /// robot_state_publisher (turns /needle/joint_states and robot_description into frames), rviz, the emulator of a
  /// device.
  std::vector<ForeignProcess> processes;
  std::vector<std::string> files;  ///< all that it was made from
  std::string text;                ///< one line for the user: what was fitted to the cell

  const NodePlan* node(const std::string& name) const;  ///< nullptr when it does not take part
  std::vector<std::string> names() const;               ///< of nodes, frames and processes
  bool takesPart(const std::string& name) const;        ///< a node, frame or process
  /// Leaves only these, and the parameters that they read. Throws ConfigError when one does not take part.
  void keepOnly(const std::vector<std::string>& names);
};

enum class SessionClock {
  kWall,    ///< live: an emulated rig is a process of its own, and a watchdog holds the force of a device that is real
  kVirtual  ///< an emulated rig is inside the node micromanipulator, which steps with it
};

/// The plan of a session that was loaded (Session::load), for a clock. Reads the files that the session names.
/// @throws ConfigError with a line for everything that does not fit
SessionPlan planOf(const Session& session, SessionClock clock);

}  // namespace microinjection
