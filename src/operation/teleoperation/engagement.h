#pragma once

#include <limits>
#include <optional>
#include <string>

#include "base/config_reader.h"

namespace microinjection {

struct EngagementConfig {
  std::string alignment = "index";  ///< after a hold: index (hand and needle belong together anew) or agree (as before)
  double tolerance = 2e-3;          ///< m of the hand, within which hand and needle agree
  double speed = 0.1;               ///< m/s of the hand, above which nothing is taken up
  double speed_limit = 0.25;        ///< m/s, above which the hand is followed no longer: a stylus that falls
  double speed_time = 5e-3;         ///< s, for which it has to be: one late sample reads as a leap
  double rest_time = 0.2;           ///< s below `speed`, after which it is taken up again: one that bounces stays held
  double interruption = 0.2;        ///< s, of a hold that is not the operator's, after which the hand may still be fast

  static EngagementConfig read(ConfigReader reader);
};

/// When the needle follows the hand: held -> align -> follow, as teleoperation does it (dVRK: ALIGNING, ENABLED;
/// franka_ros: ALIGN, TRACK).
///
/// held: an input is not valid, the operator is not there, or the clutch is pressed. align: all is well again,
/// but the needle is still held until the hand is slow and, with `agree`, is back where it left the needle, or the
/// operator has pressed and released the clutch, which is to say: from here. A device that sets a speed must be let go,
/// clutch or not. A hand that is too fast in follow has let go of the device, or nearly: back to align, until it has
/// rested.
///
/// A hand that is taken up while it moves pushes a needle that its operator may take for held; so it must be slow
/// first. But when needle or force were not valid for a moment only, within one stroke of the hand, the
/// operator cannot have noticed, and would lose the rest of the stroke: then it goes on, as fast as it may be followed,
/// from where the needle is. Not so after a clutch, a dead-man or a hand that was lost, however short.
class Engagement {
 public:
  enum class State { kHeld, kAlign, kFollow };

  struct Input {
    bool held = false;         ///< for any reason
    bool clutch = false;       ///< pressed
    double speed = 0;          ///< m/s, of the hand; 0 where it says nothing (rate mode)
    double misalignment = 0;   ///< m, of the hand (MotionMapping)
    bool interrupted = false;  ///< held for want of needle or force alone
    double dt = 1e-3;          ///< s
    bool released = true;      ///< a hand taken up here leaves the needle at rest (MotionMapping)
  };

  explicit Engagement(const EngagementConfig& config) : config_(config) {}

  State step(const Input& input);
  State state() const { return state_; }
  /// "held", "align" or "follow".
  static std::string name(State state);
  /// What the operator has to do in align.
  std::string why() const { return reason_; }

 private:
  bool tooFast(const Input& input);

  EngagementConfig config_;
  State state_ = State::kHeld;
  std::optional<double> fast_;  ///< s, for which the hand that is followed has been too fast
  double rest_ = 0;             ///< s, for which it still has to rest
  double held_time_ = std::numeric_limits<double>::infinity();  ///< s, that what followed has been interrupted;
                                                                ///< infinite: it is no interruption
  bool has_reference_ = false;  ///< hand and needle belonged together before and must agree again
  std::string reason_;
};

}  // namespace microinjection
