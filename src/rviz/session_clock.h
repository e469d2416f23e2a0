#pragma once

#include "nodes/bus/bus.h"

namespace microinjection {

/// s. In simulated time that of the session, where nodes publish as often as time goes on; else of a
/// clock that does not jump.
inline double sessionNow(const Bus& bus) { return ros::Time::isSimTime() ? bus.now().toSec() : bus.steady().toSec(); }

/// Handles the messages that came, without waiting for others: a panel has the loop of rviz's window, and no
/// Bus::run().
inline void serveArrived(Bus& bus) {
  bus.waitUntil([] { return false; }, 0);
}

/// Silence (s) after which the controller counts as gone: it publishes ten times a second.
constexpr double kControllerSilence = 1;

}  // namespace microinjection
