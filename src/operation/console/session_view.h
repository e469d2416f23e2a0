#pragma once

#include <optional>
#include <string>

#include "base/operating_state.h"
#include "operation/control/injection_state.h"

namespace microinjection {

/// What the console knows of the injection controller's parameters. Its defaults refuse nothing that
/// the controller may allow.
struct ControllerSettings {
  std::string mode;                   ///< manual, semi_automatic or automatic; empty: not known
  bool has_pulse = true;              ///< the configured goal injects
  bool has_holder = false;            ///< whose pressure the controller commands
  bool holds = true;                  ///< the configured goal has a suction to hold the cell with
  bool has_suction = true;            ///< the configured goal breaks the last membrane by suction
  std::optional<double> force_limit;  ///< N, along the pipette
  std::optional<double> depth_limit;  ///< m past the contact point
  std::string error;                  ///< values that are no numbers; empty: none
};

/// What is to be mended first before the session does what it is asked to, see Hindrance.msg.
struct HindranceView {
  std::string node, reason;
  std::string remedy;     ///< empty: not known
  bool is_error = false;  ///< else a warning
};

/// What the console knows of the injection controller from its messages. An empty state: no message
/// came, or none for too long.
struct SessionView {
  std::optional<OperatingState> operating;
  std::optional<InjectionState> injection;
  bool listens = true;  ///< the controller receives what the console sends
  bool homed = true;
  bool busy = false;                       ///< the controller moves the needle by itself
  bool waits = false;                      ///< for the operator's command
  double force = 0;                        ///< N, along the pipette, above the offset at rest
  double guard_force = 0;                  ///< N, along the pipette, as the force guard compares it
  double depth = 0;                        ///< m past the contact point; 0 before the first contact
  double volume = 0;                       ///< m^3, injected since the needle started
  std::string hold_reason;                 ///< why the needle is held; empty: it follows, or not known
  std::string notice;                      ///< why the last command was refused; empty: it was not
  std::optional<HindranceView> hindrance;  ///< an alarm of any node; none: there is none, or nobody tells
  ControllerSettings settings;

  /// Messages arrive from the controller.
  bool connected() const { return operating && injection; }
  bool byHand() const { return settings.mode == "manual"; }
};

}  // namespace microinjection
