#pragma once

#include <map>
#include <string>
#include <vector>

namespace microinjection {

/// Finds connections that roscpp has not made. It asks a publisher for a connection once; where that fails, as it may
/// on a busy machine, the node hears nothing of that publisher until one of the two is started anew. Not for the loop's
/// thread: the master may keep it waiting.
class LostPublishers {
 public:
  /// Compares the publishers of each subscribed topic at the master with the connections of this process. What was
  /// missing at the last call, too, is reported to roscpp as if by the master.
  void check();

 private:
  using Topics = std::map<std::string, std::vector<std::string>>;  ///< {topic: names of publishers}
  void compare();
  static Topics publishersAtMaster();
  static bool connect(const std::string& topic, const std::vector<std::string>& publishers);

  struct Missing {
    std::vector<std::string> publishers;  ///< all of the topic
    bool seen = false;                    ///< by an earlier check
    int tries = 0;
  };
  std::map<std::string, Missing> missing_;  ///< by topic
};

}  // namespace microinjection
