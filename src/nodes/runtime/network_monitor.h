#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace microinjection {

/// Through which interfaces others can reach this machine, looked at once a second in a thread of its own. roscpp and
/// the ROS master listen on every interface, whatever ROS_IP says, and ask nobody who they are: whoever reaches them
/// can end a node or connect it to another master.
class NetworkMonitor {
 public:
  NetworkMonitor();
  ~NetworkMonitor();
  NetworkMonitor(const NetworkMonitor&) = delete;
  NetworkMonitor& operator=(const NetworkMonitor&) = delete;

  /// Neither waits nor locks.
  bool reachable() const { return reachable_; }
  /// The interfaces that are up, connected and have an address, but the loopback, e.g. "eth0 (192.168.1.5)"; empty:
  /// none.
  std::string interfaces() const;

 private:
  void look();

  std::atomic<bool> reachable_{false};
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::string interfaces_;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace microinjection
