#pragma once

#include <cstdint>

namespace microinjection {

/// What is_busy of CRTK's operating_state says from step to step, so that each accepted motion brings one true and then
/// one false: also a motion of no length, and one that takes over from another. The released CRTK client waits for a
/// true whose stamp is later than its command, and for a false after it.
class BusyReport {
 public:
  /// A motion was accepted at `time` (ns).
  void accept(std::int64_t time) {
    pending_ = true;
    accepted_ = time;
  }

  /// A motion was accepted whose true is still to be said. What else has changed by it waits for that.
  bool pending() const { return pending_; }

  /// What to say at `time` (ns), when motions are (`busy`) or are not under way.
  bool step(bool busy, std::int64_t time) {
    if (time < last_) accepted_ = time - 1;  // a clock that was set back
    last_ = time;
    if (!pending_) {
      said_ = busy;
    } else if (said_) {
      said_ = false;  // the end of the motion before
    } else if (time > accepted_) {
      said_ = true;
      pending_ = false;
    }
    return said_;
  }

 private:
  bool pending_ = false;  ///< a motion was accepted, and no true was said since
  bool said_ = false;
  std::int64_t accepted_ = 0;  ///< ns
  std::int64_t last_ = 0;      ///< ns
};

}  // namespace microinjection
