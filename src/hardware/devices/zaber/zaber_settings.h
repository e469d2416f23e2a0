#pragma once

#include <array>
#include <optional>
#include <string>

#include "hardware/devices/zaber/zaber_protocol.h"

namespace microinjection {

/// Settings of an axis, read once per connection. A value needs two equal replies, since the effect
/// of a damaged one would last.
class ZaberSettings {
 public:
  enum Name { kVersion, kLowest, kHighest, kAcceleration, kDeceleration, kResolution, kSerial, kNames };

  static std::string command(Name name);
  /// To be requested from axis 0. The serial number only shows whether two devices answer.
  static bool ofDevice(Name name) { return name == kVersion || name == kSerial; }
  /// Older firmware and direct drives do not have all of them.
  static bool mayBeUnknown(Name name) { return name == kDeceleration || name == kResolution || name == kSerial; }

  std::optional<Name> missing() const;  ///< the next to be read; empty: all are valid
  void add(Name name, const std::string& data);
  void setUnsupported(Name name);  ///< the device does not have it
  void clear() { *this = {}; }

  bool movesHaveSpeeds() const { return moves_have_speeds_.value_or(false); }  ///< of their own
  bool oldFirmware() const { return moves_have_speeds_ == false; }
  std::optional<std::int64_t> number(Name name) const { return numbers_[name]; }  ///< data of the setting

 private:
  std::array<std::string, kNames> last_;
  std::array<bool, kNames> confirmed_{};
  std::array<std::optional<std::int64_t>, kNames> numbers_;
  std::optional<bool> moves_have_speeds_;
};

}  // namespace microinjection
