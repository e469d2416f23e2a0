#pragma once

#include <diagnostic_updater/diagnostic_updater.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "nodes/recording/session_bag.h"
#include "operation/record/row_file.h"

namespace microinjection {

/// The growing files of a session, force_depth.csv and session.bag. A file that cannot be written
/// is reported in the log and on /diagnostics; the session continues.
class SessionFiles {
 public:
  /// Creates the folder and its files. @throws std::exception  when they cannot be created
  SessionFiles(const std::string& folder, const std::string& header, bool bag);

  RowFile& rows() { return rows_; }
  SessionBag* bag() { return bag_.get(); }  ///< null without a bag

  /// Writes the rows since the last step.
  void step(const ros::Time& now);
  /// Completes both files. Returns a text for each incomplete one.
  std::vector<std::string> finish();
  void report(diagnostic_updater::DiagnosticStatusWrapper& status) const;

 private:
  RowFile rows_;
  std::unique_ptr<SessionBag> bag_;
  bool failing_ = false;            ///< rows are lost, or were less than a second ago
  std::string error_text_;          ///< last error of the rows
  std::uint64_t failed_at_ns_ = 0;  ///< ROS time
};

}  // namespace microinjection
