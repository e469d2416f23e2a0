#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <rosbag/bag.h>

#include <cerrno>
#include <cstdint>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "nodes/bus/bus.h"
#include "nodes/runtime/ports.h"
#include "operation/record/row_file.h"

namespace microinjection {

/// The bag of a session, written by the recorder from the messages that it receives anyway: a
/// second process with all subscriptions would cost half a core. The file's name ends in .active
/// until it is complete. The bag ends where it cannot be written; errorText() has the reason.
class SessionBag {
 public:
  /// Creates missing directories. @throws std::exception when the file cannot be written.
  explicit SessionBag(const std::string& path);
  ~SessionBag() { close(); }
  SessionBag(const SessionBag&) = delete;
  SessionBag& operator=(const SessionBag&) = delete;

  /// Writes every message of this input from now on.
  template <typename Message>
  void record(Input<Message>& input) {
    const std::string topic = "/" + input.topic;
    input.onMessage([this, topic](const Message& message, const ros::Time& now) { write(topic, now, message); });
  }

  /// Writes every message of a topic that is no input from now on.
  template <typename Message>
  void record(Bus& bus, const std::string& topic) {
    subscriptions_.push_back(bus.subscribe<Message>(topic, 100, [this, &bus, topic](const Delivery<Message>& delivery) {
      write(topic, bus.now(), *delivery.message);
    }));
  }

  /// Completes the file; later messages are not written. Returns empty, or why the bag is
  /// incomplete.
  std::string close();

  /// Why the bag is incomplete, with its path; else empty.
  const std::string& errorText() const { return error_text_; }

 private:
  template <typename Message>
  void write(const std::string& topic, const ros::Time& now, const Message& message) {
    if (!bag_ || now <= ros::TIME_MIN) return;
    errno = 0;
    try {
      bag_->write(topic, now, message);
    } catch (const std::exception& error) {  // a full disk must not end the session
      const int reason = errno;
      abort(error.what(), reason);
    }
  }
  void abort(const std::string& what, int reason);

  std::string path_;
  std::unique_ptr<rosbag::Bag> bag_;  ///< null when it is closed
  std::string error_text_;
  std::vector<Subscription> subscriptions_;
};

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

/// Local date and time, ISO 8601. In virtual time the session's, as UTC, so that all runs write the same.
std::string localTime(const Bus& bus);

}  // namespace microinjection
