#pragma once

#include <algorithm>
#include <functional>
#include <optional>

namespace microinjection {

/// The liveness rule of every measured stream: whether its source repeats one reading, however fresh the stamps are. A
/// driver whose device hangs, a relay whose input is gone and a receiver without its gamepad do that.
///
/// What lives changes, but not at once: a reading may stay for a limited *exposure* to what changes it. Each stream has
/// its own:
///
///     stream                   what changes it          exposure                            limit
///     force of a sensor        noise above its step     readings                            ForceLiveness::kReadings
///     force of a touched cell  the needle's way         m of it                             ForceLiveness::kWay
///     needle's pose            its set-point's way      s with the set-point elsewhere      0.2 s + the rig's times
///     hand's pose              tremor                   s                                   timeouts/hand_unchanged
///     stick                    the hand that holds it   s x deflection                      RateInputConfig::renewal
///     camera's image           noise of its pixels      images                              none: the first one counts
///
/// A source that may repeat itself (a sensor whose noise is below its step, a hand that is generated) has no exposure,
/// and says so in its configuration.
///
/// `Same`: whether two readings are the same to the last bit.
template <typename Reading, typename Same = std::equal_to<Reading>>
class Repetition {
 public:
  explicit Repetition(double limit) : limit_(limit) {}

  /// Whether the reading is another than the last one; the exposure then starts anew.
  bool changes(const Reading& reading) {
    if (last_ && Same()(*last_, reading)) return false;
    last_ = reading;
    exposure_ = 0;
    return true;
  }
  /// Exposes the last reading to `exposure` more.
  void expose(double exposure) { exposure_ += exposure; }
  /// Exposes it to `exposure` since it came first, of a kind that can also grow less.
  void exposeTo(double exposure) { exposure_ = std::max(exposure_, exposure); }
  /// A reading after an `exposure` since the last one. Returns repeats().
  bool step(const Reading& reading, double exposure) {
    if (!changes(reading)) expose(exposure);
    return repeats();
  }
  void reset() {
    last_.reset();
    exposure_ = 0;
  }

  bool repeats() const { return exposure_ > limit_; }

 private:
  double limit_, exposure_ = 0;
  std::optional<Reading> last_;
};

}  // namespace microinjection
