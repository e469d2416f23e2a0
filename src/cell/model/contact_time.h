#pragma once

#include <algorithm>
#include <limits>
#include <optional>

#include "cell/model/online_cell.h"

namespace microinjection {

/// The time that a TipPath has come to in one contact, from the questions that it is asked.
class ContactTime {
 public:
  /// @param viscous whether the path takes time at all
  /// @param lead s, before the touch from which the first way in a contact is counted. The tangent of a short way is
  /// the stiffer the more viscous the cell is, and that of the first one has to serve until the next solution.
  explicit ContactTime(bool viscous, double lead = 0) : viscous_(viscous), start_offset_(lead) {}

  /// Whether the path has to start again, from the cell without the needle, before it follows: what stuck, and what
  /// relaxed, was of another contact, or of the time before the touch.
  bool startsAgain(const TipMotion& move) {
    if (move.contact == contact_ && (!viscous_ || move.touched == touched_)) return false;
    contact_ = move.contact;
    touched_ = move.touched;
    time_ = move.touched.value_or(move.time) - start_offset_;
    return true;
  }

  /// s, that going `share` of the way to the tip takes; infinite where nothing viscous resists, as before the touch.
  double pass(const TipMotion& move, double share = 1) {
    const double duration = std::max(share * (move.time - time_), kShortest);
    time_ += duration;
    return viscous_ && move.touched ? duration : std::numeric_limits<double>::infinity();
  }

 private:
  static constexpr double kShortest = 1e-3;  ///< s: a clock may stand

  bool viscous_;
  double start_offset_;  ///< s
  unsigned contact_ = 0;
  std::optional<double> touched_;  ///< s
  double time_ = 0;                ///< s, that the state has come to
};

}  // namespace microinjection
