#pragma once

#include <memory>

#include "nodes/runtime/awake_time.h"

namespace microinjection {

/// Checks each 0.5 s (of wall time), in its own thread, whether the ROS master is present and this
/// node registered. Connected topics outlive the master, but no new publisher can connect, such as
/// one that sends `disable`. A restarted master does not know the running nodes; they stay lost
/// until they restart.
class MasterMonitor {
 public:
  /// Use between ros::init and the end of ROS.
  MasterMonitor();
  ~MasterMonitor();
  MasterMonitor(const MasterMonitor&) = delete;
  MasterMonitor& operator=(const MasterMonitor&) = delete;

  /// Must be called at least every AwakeTime::kLongestStep. Does not block.
  void step(const ros::SteadyTime& now);
  /// A master that is absent or refuses is lost, and one that has not replied for 5 s in which this process ran: one
  /// that was frozen meanwhile knows nothing of its master. Does not block.
  bool lost() const;
  /// Whether the master is lost for longer than the parameter /orphan_timeout (s of wall time;
  /// default 60, in (0, inf)). The node must then end by itself. Does not block. A node that never
  /// calls this is still in its constructor, where roscpp waits for the master for ever: the
  /// monitor then shuts ROS down.
  bool masterLostForLong() const;

 private:
  struct Shared;
  AwakeTime awake_;
  std::shared_ptr<Shared> shared_;  // shared with the thread, which cannot be stopped while the master blocks it
};

}  // namespace microinjection
