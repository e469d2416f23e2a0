#pragma once

#include <algorithm>
#include <limits>
#include <optional>
#include <string>

#include "base/config_reader.h"

namespace microinjection {

struct EngagementConfig {
  std::string mode = "index";  ///< after a hold: index (new reference of hand and needle) or agree (the last one)
  double tolerance = 2e-3;     ///< m of the hand, largest misalignment that counts as agreement
  double speed = 0.1;          ///< m/s, largest speed of the hand at engagement
  double speed_limit = 0.25;   ///< m/s, above which the hand is disengaged: the stylus falls
  double speed_time = 5e-3;    ///< s above speed_limit before that: one late sample looks like a jump
  double rest_time = 0.2;      ///< s below `speed` before the next engagement: a bouncing stylus stays held
  double interruption = 0.2;   ///< s, longest hold not caused by the operator that leaves the stroke intact

  static EngagementConfig read(ConfigReader reader);
  /// m, of a hand that may lead the needle from one measurement to the next, `dt` (s) later. The stamps of a driver may
  /// come 10 ms too close.
  double longestStep(double dt) const { return speed_limit * std::max(dt, 0.01); }
};

/// Decides when the needle follows the hand: held -> align -> follow, as other teleoperation
/// systems do (dVRK: ALIGNING, ENABLED; franka_ros: ALIGN, TRACK).
///
/// - held: an input is invalid, the operator is absent, or the clutch is pressed.
/// - align: all inputs are valid, but the needle is still held until the hand is slow. With `agree`
///   the hand must also return to where it left the needle, or the operator presses and releases
///   the clutch to set a new reference. A device that sets a speed must be released first, with or
///   without a clutch.
/// - follow: a hand above speed_limit no longer holds the device, and one whose position leaps is not
///   where its device says. It returns to align until it has rested.
///
/// The hand must be slow at engagement: a fast one would push a needle that the operator believes
/// to be held. One case is exempt: needle or force were invalid for less than `interruption`,
/// within one stroke. The operator cannot have noticed and would lose the rest of the stroke. The
/// needle then follows at any speed up to speed_limit, from its present position. An interruption
/// by clutch, dead-man switch or a lost hand never qualifies.
class Engagement {
 public:
  enum class State { kHeld, kAlign, kFollow };

  struct Input {
    bool held = false;         ///< an input is invalid, the operator absent or the clutch pressed
    bool clutch = false;       ///< pressed
    double speed = 0;          ///< m/s, of the hand; 0 in rate mode, where it has no meaning
    double misalignment = 0;   ///< m, of the hand (MotionMapping)
    bool interrupted = false;  ///< held only because needle or force is invalid
    double dt = 1e-3;          ///< s
    bool released = true;      ///< the hand here commands no motion (MotionMapping::isAtRest)
    bool leaps = false;        ///< its last step was longer than EngagementConfig::longestStep
  };

  explicit Engagement(const EngagementConfig& config) : config_(config) {}

  State step(const Input& input);
  State state() const { return state_; }
  /// "held", "align" or "follow".
  static std::string name(State state);
  /// What the operator has to do in align; empty in the other states.
  std::string reason() const { return reason_; }

 private:
  bool tooFast(const Input& input);

  EngagementConfig config_;
  State state_ = State::kHeld;
  std::optional<double> fast_time_;                             ///< s, time of the followed hand above speed_limit
  double rest_time_left_ = 0;                                   ///< s, time the hand still has to rest
  double held_time_ = std::numeric_limits<double>::infinity();  ///< s, duration of the interruption of a stroke;
                                                                ///< infinite: it is no interruption
  bool has_reference_ = false;                                  ///< an earlier reference of hand and needle exists
  std::string reason_;
};

}  // namespace microinjection
