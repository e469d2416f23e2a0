#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace microinjection {

/// Lists the interfaces over which others can reach this machine, once a second in its own thread.
/// roscpp and the ROS master accept connections on every interface, whatever ROS_IP is, without
/// authentication: anyone who reaches them can end a node or connect it to another master.
class NetworkMonitor {
 public:
  NetworkMonitor();
  ~NetworkMonitor();
  NetworkMonitor(const NetworkMonitor&) = delete;
  NetworkMonitor& operator=(const NetworkMonitor&) = delete;

  /// Does not block.
  bool reachable() const { return reachable_; }
  /// The interfaces that are up, connected and have an address, without the loopback, e.g. "eth0
  /// (192.168.1.5)".
  std::string interfaces() const;

 private:
  void check();

  std::atomic<bool> reachable_{false};
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::string interfaces_;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace microinjection
