#pragma once

#include <termios.h>

#include <functional>
#include <string>

namespace microinjection {

/// What a mode of a serial line would change in bytes that pass it, by termios' names such as "ISTRIP, IXON"; empty:
/// nothing. A system may keep a setting and report no error (POSIX, tcsetattr), so it is read back: one stripped bit
/// of a binary target sends a needle elsewhere.
std::string whatChangesBytes(const termios& mode);

/// Requests that the driver of the serial port `fd` delivers received bytes at once
/// (ASYNC_LOW_LATENCY of Linux). The driver of FTDI's USB adapters then lowers the adapter's
/// latency timer from 16 ms to 1 ms. Other drivers and pseudo-terminals may not support the flag
/// and stay unchanged.
/// @param control  system call, ::ioctl; replaceable for tests
/// @returns whether the flag is set now
bool requestLowLatency(int fd,
                       const std::function<int(int fd, unsigned long request, void* argument)>& control = nullptr);

}  // namespace microinjection
