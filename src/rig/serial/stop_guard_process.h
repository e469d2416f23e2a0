#pragma once

#include <cstddef>

namespace microinjection {

/// Bytes between the driver and its stop guard, one a message.
constexpr char kStopGuardBeat = 'b';     ///< to the guard: the driver was stepped
constexpr char kStopGuardEcho = 'e';     ///< from it: beats have come since the last one
constexpr char kStopGuardStopped = 's';  ///< from it: no beat came for kStopGuardSilence; the stop has been sent

constexpr double kStopGuardSilence = 0.2;  ///< s without a beat after which a driver stands still, or without an echo

/// Where the kernel reads a process's command line; null when it was not found.
struct CommandLine {
  char* text = nullptr;
  std::size_t size = 0;
};
/// Of this process. To be called before the fork.
CommandLine findCommandLine();

/// The guard's life, in a process of its own: sends `stop` on `line` when the driver at the other end of the socket
/// `driver` is gone, and again and again while it sends no beat. `line` must be non-blocking; both descriptors > 2.
/// It overwrites `program` with a name of its own, so that `pkill -f` with the driver's name does not end it as well,
/// and locks its memory where the limits allow that, so that it runs while the machine swaps.
///
/// It is the child of a fork in a program with threads: only what is safe in a signal handler may be called.
[[noreturn]] void runStopGuard(int line, int driver, const char* stop, std::size_t size, CommandLine program);

}  // namespace microinjection
