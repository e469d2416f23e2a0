#pragma once

#include <cstddef>

namespace microinjection {

/// Messages between the driver and its stop guard, one byte each.
constexpr char kStopGuardBeat = 'b';     ///< to the guard: the driver was stepped
constexpr char kStopGuardEcho = 'e';     ///< from the guard: it received heartbeats since the last echo
constexpr char kStopGuardStopped = 's';  ///< from the guard: no heartbeat for kStopGuardSilence, the stop has been sent

/// s without a heartbeat after which a driver, or without an echo after which a guard, is frozen
constexpr double kStopGuardSilence = 0.2;

/// Where the kernel reads a process's command line; null if it was not found.
struct CommandLine {
  char* text = nullptr;
  std::size_t size = 0;
};
/// Command line of this process. Call it before the fork.
CommandLine findCommandLine();

/// Main loop of the guard process. Sends `stop` on `line` when the driver at the other end of the
/// socket `driver` has terminated, and repeatedly while the driver sends no heartbeat. `line` must
/// be non-blocking; both descriptors must be > 2.
///
/// `apart` (s), if it is not 0: between two stops, and a second one follows the driver's end.
///
/// It overwrites `program` with a name of its own, so that `pkill -f` with the driver's name does
/// not kill it. It locks its memory if the limits allow it, so that it runs while the machine
/// swaps.
///
/// It runs in the child of a fork of a multi-threaded program, so it may only call
/// async-signal-safe functions.
[[noreturn]] void runStopGuard(int line, int driver, const char* stop, std::size_t size, double apart,
                               CommandLine program);

}  // namespace microinjection
