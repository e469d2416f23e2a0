#pragma once

#include <optional>
#include <string>

#include "operation/console/light.h"

namespace microinjection {

/// What the console knows of the parameters of haptic_bridge.
struct HandSettings {
  std::string mode, force_source;        ///< empty: not known
  std::optional<double> position_scale;  ///< m of the needle per m of the hand
  std::optional<double> rate_gain;       ///< 1/s, speed of the needle per m of the hand past the dead zone
  std::optional<double> force_gain;      ///< N at the hand per N at the tip
  std::string error;                     ///< values that are no numbers; empty: none
};

/// What the console knows of the hand. Empty: no message came.
struct HandView {
  std::optional<bool> clutch;              ///< pressed
  std::optional<bool> present;             ///< the dead-man switch is held
  std::optional<std::string> hold_reason;  ///< of haptic_bridge; an empty text: the needle follows
  bool has_bridge = false;                 ///< haptic_bridge was heard
  HandSettings settings;
};

/// Green: the needle follows the hand. Yellow: it is held, with the reason. Red: the bridge has fallen silent. Grey:
/// the session has none.
Lamp followsLamp(const HandView& hand);
/// Green: the hand leads. Yellow: the clutch is pressed. Grey: the device has none.
Lamp clutchLamp(const HandView& hand);
/// Green: held. Yellow: released. Grey: the device has none.
Lamp presentLamp(const HandView& hand);

/// "1 mm of the hand: 1.00 um", or in rate mode "10 mm of the hand: 20 um/s"; "-": not known. The values that are no
/// numbers come first.
std::string positionScaleText(const HandSettings& settings);
/// "1 uN at the tip: 0.20 N, predicted"; "-": not known.
std::string forceScaleText(const HandSettings& settings);

}  // namespace microinjection
