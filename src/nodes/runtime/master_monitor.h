#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

namespace microinjection {

/// Whether the ROS master is there and knows this node, asked each 0.5 s (of wall time) in a thread of its own. Topics
/// that are connected outlive the master, but nobody new can be heard any more, such as who sends `disable`. A master
/// that was started anew knows none of the nodes that run: to it they are lost until they are started again.
class MasterMonitor {
 public:
  /// Between ros::init and the end of ROS. A master that is not there, or refuses, is lost; where `timed`, one that has
  /// not answered for 5 s, too: else nothing depends on how fast this machine is.
  explicit MasterMonitor(bool timed);
  ~MasterMonitor();
  MasterMonitor(const MasterMonitor&) = delete;
  MasterMonitor& operator=(const MasterMonitor&) = delete;

  /// Neither waits nor locks.
  bool lost() const;
  /// Lost for longer than the parameter /orphan_timeout (s of wall time; default 60, in (0, inf)): whoever started this
  /// node is gone, too. Neither waits nor locks. Who asks must end by itself. A node that never asks is still in its
  /// constructor, where roscpp waits for the master for ever: ROS is then asked to shut down.
  bool masterLostForLong() const;

 private:
  struct Shared;
  bool timed_;
  std::shared_ptr<Shared> shared_;  // the thread's, too: it cannot be stopped while a master keeps it waiting
};

}  // namespace microinjection
