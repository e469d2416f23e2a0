#pragma once

#include <diagnostic_updater/diagnostic_updater.h>

#include <map>
#include <mutex>
#include <string>

namespace microinjection {

/// The refused messages of a node, by topic and reason. Any thread may add to it. The log has at most
/// one line a second, the diagnostics have all.
class MessageRefusals {
 public:
  void add(const std::string& topic, const std::string& reason);

  /// Merges a warning for each topic with refusals since the last call, and adds all counts since
  /// the start.
  void report(diagnostic_updater::DiagnosticStatusWrapper& status);

 private:
  struct Topic {
    unsigned count = 0;     ///< since the start
    unsigned reported = 0;  ///< of those, in the last report
    std::string reason;     ///< of the last one
  };

  std::mutex mutex_;
  std::map<std::string, Topic> topics_;
};

}  // namespace microinjection
