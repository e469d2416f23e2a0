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

  void receive(const std::string& sender, const ros::Time& now) {
    if (sender != sender_) {
      std::swap(sender_, other_);
      std::swap(sent_, other_sent_);
      sender_ = sender;
    }
    sent_ = now;
  }

  /// Both names while two nodes send; else empty.
  std::string rivals(const ros::Time& now) const {
    if (other_.empty() || isDue(other_sent_, now, kHandOver)) return "";
    return other_ < sender_ ? other_ + " and " + sender_ : sender_ + " and " + other_;
  }

 private:
  std::string sender_, other_;  ///< the last one, and the last one before it that is another
  ros::Time sent_, other_sent_;
};

}  // namespace microinjection
