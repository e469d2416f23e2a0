#pragma once

#include <deque>
#include <string>

namespace microinjection {

/// An emulated device's answers, each said when it is due.
class AnswerQueue {
 public:
  void add(const std::string& bytes, double due) { answers_.push_back({bytes, due}); }
  /// What is due by `time` (s), in order.
  std::string take(double time) {
    std::string said;
    for (; !answers_.empty() && answers_.front().due <= time; answers_.pop_front()) said += answers_.front().bytes;
    return said;
  }

 private:
  struct Answer {
    std::string bytes;
    double due;  // s
  };
  std::deque<Answer> answers_;
};

}  // namespace microinjection
