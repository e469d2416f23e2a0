#pragma once

#include <cstdint>

namespace microinjection {

/// Sequence of is_busy in CRTK's operating_state. Each accepted motion publishes one true and then
/// one false, also a motion of zero length and one that replaces another. The released CRTK client
/// waits for a true with a stamp later than its command, and then for a false.
class BusyReport {
 public:
  /// A motion was accepted at `time` (ns).
  void accept(std::int64_t time) {
    pending_ = true;
    accepted_ = time;
  }

  /// A motion was accepted and its true was not published yet. Other changes that the motion causes
  /// are published with it.
  bool pending() const { return pending_; }

  /// Value to publish at `time` (ns). `busy`: a motion is under way.
  bool step(bool busy, std::int64_t time) {
    if (time < last_) accepted_ = time - 1;  // the clock was set back
    last_ = time;
    if (!pending_) {
      busy_ = busy;
    } else if (busy_) {
      busy_ = false;  // ends the previous motion
    } else if (time > accepted_) {
      busy_ = true;
      pending_ = false;
    }
    return busy_;
  }

 private:
  bool pending_ = false;  ///< a motion was accepted and no true was published since
  bool busy_ = false;
  std::int64_t accepted_ = 0;  ///< ns
  std::int64_t last_ = 0;      ///< ns
};

}  // namespace microinjection
