#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>

#include <functional>
#include <optional>
#include <string>

#include "nodes/bus/bus.h"

namespace microinjection {

/// What one node says of itself on /diagnostics.
class NodeDiagnostics {
 public:
  using Handler = std::function<void(const diagnostic_msgs::DiagnosticStatus& status)>;

  /// @param name  of the status, as "force_sensor: sensor"
  explicit NodeDiagnostics(std::string name, Handler handler = {});
  /// Subscribes: a box that is not shown has no use for the messages.
  void start(Bus& bus);
  bool isFresh() const;  ///< the node reports each second

 private:
  void read(const diagnostic_msgs::DiagnosticArray& message);

  std::string name_;
  Handler handler_;
  Bus* bus_ = nullptr;              ///< null: not started
  std::optional<double> heard_at_;  ///< s, sessionNow()
  Subscription reports_;
};

}  // namespace microinjection
