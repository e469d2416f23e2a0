#pragma once

#include <rosbag/bag.h>

#include <cerrno>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "nodes/runtime/ports.h"

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

}  // namespace microinjection
