#pragma once

#include <map>
#include <string>
#include <vector>

namespace microinjection {

/// {topic: names of its publishers, without this node}, from the master; empty without a reply.
std::map<std::string, std::vector<std::string>> publishersAtMaster();

/// Restores connections that roscpp failed to make. roscpp requests a connection from a publisher
/// once. When that fails, as it may on a busy machine, the node receives nothing from that
/// publisher until one of the two restarts. Do not call it in the loop's thread: the master may
/// block it.
class LostPublishers {
 public:
  /// Compares the publishers of each subscribed topic at the master with the connections of this
  /// process. Publishers missing at two calls in a row are reported to roscpp as if by the master.
  void check();

 private:
  void compare();
  static bool connect(const std::string& topic, const std::vector<std::string>& publishers);

  struct Missing {
    std::vector<std::string> publishers;  ///< all of the topic's
    bool seen = false;                    ///< by an earlier check
    int tries = 0;
  };
  std::map<std::string, Missing> missing_;  ///< by topic
};

}  // namespace microinjection
