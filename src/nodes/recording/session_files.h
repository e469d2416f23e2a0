#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "nodes/recording/session_bag.h"
#include "operation/record/row_file.h"

namespace microinjection {

/// The files of a session that grow while it runs, force_depth.csv and session.bag, and what is wrong with them. A file
/// that cannot be written is reported in the log and on /diagnostics; the session goes on.
class SessionFiles {
 public:
  /// Makes the folder and the files in it. @throws std::exception  when they cannot be made
  SessionFiles(const std::string& folder, const std::string& header, bool bag);

  RowFile& rows() { return rows_; }
  SessionBag* bag() { return bag_.get(); }  ///< null without a bag

  /// Writes the rows that came since the step before.
  void step(const ros::Time& now);
  /// Completes both files. What is wrong with them, a text each; none where both are whole.
  std::vector<std::string> finish();
  void report(diagnostic_updater::DiagnosticStatusWrapper& status) const;

 private:
  RowFile rows_;
  std::unique_ptr<SessionBag> bag_;
  bool failing_ = false;            ///< rows are being lost, or were a moment ago
  std::string trouble_;             ///< the last of the rows
  std::uint64_t failed_at_ns_ = 0;  ///< ROS time
};

}  // namespace microinjection
