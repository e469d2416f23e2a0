#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <diagnostic_updater/diagnostic_updater.h>

#include <string>

#include "nodes/bus/bus.h"

namespace microinjection {

/// Publishes the tasks of a node on /diagnostics, each `~diagnostic_period` of the session's time (s,
/// default 1). As diagnostic_updater::Updater, whose tasks it takes, but on a bus.
class Diagnostics : public diagnostic_updater::DiagnosticTaskVector {
 public:
  explicit Diagnostics(Bus& bus);

  double period() const { return period_; }  ///< s
  /// Publishes when a period has passed. @returns whether it has
  bool update();
  /// Publishes one task at once.
  void publish(const std::string& task);

 private:
  void publish(const std::vector<diagnostic_msgs::DiagnosticStatus>& statuses);
  diagnostic_updater::DiagnosticStatusWrapper run(const DiagnosticTaskInternal& task) const;

  Bus& bus_;
  double period_ = 1;  // s
  ros::Time updated_;
  Publisher<diagnostic_msgs::DiagnosticArray> publisher_;
};

}  // namespace microinjection
