#pragma once

#include <deque>
#include <string>

namespace microinjection {

/// Replies of an emulated device, each sent when it is due.
class ReplyQueue {
 public:
  void add(const std::string& bytes, double due) { replies_.push_back({bytes, due}); }
  /// Removes and returns the replies that are due by `time` (s), in order.
  std::string popDue(double time) {
    std::string output;
    for (; !replies_.empty() && replies_.front().due <= time; replies_.pop_front()) output += replies_.front().bytes;
    return output;
  }

 private:
  struct Reply {
    std::string bytes;
    double due;  // s
  };
  std::deque<Reply> replies_;
};

}  // namespace microinjection
