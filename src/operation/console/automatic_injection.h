#pragma once

#include <string>

#include "operation/console/console_commands.h"

namespace microinjection {

/// Feedback of the action /controller/inject, SI units.
struct InjectionProgress {
  std::string state;
  int layer = 0, layers = 0;  ///< next of the goal's layers, from 1 on; 0 of 0: without puncture
  double depth = 0, force = 0, elapsed = 0;
};

/// What the button does that starts the configured injection in mode automatic.
/// @param there    the action answers
/// @param running  the console's goal is under way
CommandOffer offerInjection(const SessionView& session, bool there, bool running);

/// "indent, layer 1 of 2, 12.3 um deep, 1.20 uN, 3 s"
std::string progressText(const InjectionProgress& progress);

/// "injected: 5.0 pL through 1 membrane", or the outcome with its reason.
std::string outcomeText(const std::string& outcome, const std::string& reason, int punctures, double volume);
/// The goal was reached: an injection, a puncture or an indentation.
bool isReached(const std::string& outcome);

}  // namespace microinjection
