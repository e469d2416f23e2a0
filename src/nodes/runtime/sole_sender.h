#pragma once

#include <ros/time.h>

#include <string>
#include <utility>

#include "nodes/runtime/stamps.h"

namespace microinjection {

/// Who sends the messages of a topic that one node sends. Another sender while the first one still sends is a rival: a
/// foreign publisher, a second session, a node that was started twice. A node that takes over from one that has ended
/// is none.
class SoleSender {
 public:
  static constexpr double kHandOver = 0.5;  ///< s without the other one, until a sender is the only one
  /// Of a topic that has changes only, s from a sender's first message, while both are there. Not for ever, since a
  /// node that was killed is there for ever.
  static constexpr double kHandOverOfChanges = 3;

  void receive(const std::string& sender, const ros::Time& now) {
    if (sender != sender_) {
      std::swap(sender_, other_);
      std::swap(sent_, other_sent_);
      sender_ = sender;
      began_ = now;
    }
    sent_ = now;
  }
  /// Receives. @returns why the message does not count; empty: it does
  std::string refusalOf(const std::string& sender, const ros::Time& now) {
    receive(sender, now);
    const std::string both = rivals(now);
    return both.empty() ? "" : "it is sent by two nodes, " + both + ": none counts until one has stopped";
  }

  /// Both names while two nodes send; else empty. `both_are_there`: of a topic that has changes only, whose other
  /// sender may be silent for long and then send the next one.
  std::string rivals(const ros::Time& now, bool both_are_there = false) const {
    if (other_.empty()) return "";
    if (both_are_there ? isDue(began_, now, kHandOverOfChanges) : isDue(other_sent_, now, kHandOver)) return "";
    return other_ < sender_ ? other_ + " and " + sender_ : sender_ + " and " + other_;
  }

 private:
  std::string sender_, other_;           ///< the last one, and the last one before it that is another
  ros::Time sent_, other_sent_, began_;  ///< `began_`: of the last one, since the other one's last message
};

}  // namespace microinjection
