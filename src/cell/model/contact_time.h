#pragma once

#include <algorithm>
#include <limits>
#include <optional>

#include "cell/model/live_cell.h"

namespace microinjection {

/// Time that a TipPath has simulated within one contact.
class ContactTime {
 public:
  /// @param viscous whether the path depends on time
  /// @param lead s, time before first contact at which the first step of a contact begins. The
  ///   tangent of a short step of a viscous cell is stiff, and that of the first one is used until
  ///   the next solution.
  explicit ContactTime(bool viscous, double lead = 0) : viscous_(viscous), start_offset_(lead) {}

  /// Whether the path must restart from the undeformed cell before this move, because its state
  /// belongs to another contact or to the time before first contact.
  bool mustRestart(const TipMotion& move) {
    if (move.contact == contact_ && (!viscous_ || move.contact_start == contact_start_)) return false;
    contact_ = move.contact;
    contact_start_ = move.contact_start;
    time_ = move.contact_start.value_or(move.time) - start_offset_;
    return true;
  }

  /// Duration (s) of moving by `share` of the distance to the tip; infinite when the path does not
  /// depend on time, or before first contact.
  double advance(const TipMotion& move, double share = 1) {
    const double duration = std::max(share * (move.time - time_), kShortest);
    time_ += duration;
    return viscous_ && move.contact_start ? duration : std::numeric_limits<double>::infinity();
  }

 private:
  static constexpr double kShortest = 1e-3;  ///< s: the clock may not advance

  bool viscous_;
  double start_offset_;  ///< s
  unsigned contact_ = 0;
  std::optional<double> contact_start_;  ///< s
  double time_ = 0;                      ///< s, of the state
};

}  // namespace microinjection
