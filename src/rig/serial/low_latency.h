#pragma once

#include <functional>

namespace microinjection {

/// Asks the driver of the serial port `fd` to hand over at once what has come (ASYNC_LOW_LATENCY of Linux). The driver
/// of FTDI's USB adapters then lowers the adapter's latency timer from 16 ms to 1 ms; other drivers, and
/// pseudo-terminals, may know no such flag, and are left as they are.
/// @param control  of the system, ::ioctl; for tests
/// @returns whether the flag is set now
bool requestLowLatency(int fd,
                       const std::function<int(int fd, unsigned long request, void* argument)>& control = nullptr);

}  // namespace microinjection
