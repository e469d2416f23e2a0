#include "hardware/serial/low_latency.h"

#include <linux/serial.h>
#include <sys/ioctl.h>

namespace microinjection {

bool requestLowLatency(int fd, const std::function<int(int, unsigned long, void*)>& control) {
  const auto call = [&](unsigned long request, serial_struct& port) {
    return (control ? control(fd, request, &port) : ::ioctl(fd, request, &port)) == 0;
  };
  serial_struct port{};
  if (!call(TIOCGSERIAL, port)) return false;
  if ((port.flags & ASYNC_LOW_LATENCY) != 0) return true;
  port.flags |= ASYNC_LOW_LATENCY;
  return call(TIOCSSERIAL, port) && call(TIOCGSERIAL, port) && (port.flags & ASYNC_LOW_LATENCY) != 0;
}

}  // namespace microinjection
