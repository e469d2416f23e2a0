#include "hardware/serial/line_mode.h"

#include <linux/serial.h>
#include <sys/ioctl.h>

namespace microinjection {

std::string whatChangesBytes(const termios& mode) {
  std::string found;
  const auto check = [&](const char* name, bool changes) {
    if (changes) found += (found.empty() ? "" : ", ") + std::string(name);
  };
  check("CS5 to CS7", (mode.c_cflag & CSIZE) != CS8);
  check("ISTRIP", (mode.c_iflag & ISTRIP) != 0);
  check("INLCR", (mode.c_iflag & INLCR) != 0);
  check("IGNCR", (mode.c_iflag & IGNCR) != 0);
  check("ICRNL", (mode.c_iflag & ICRNL) != 0);
  check("PARMRK", (mode.c_iflag & PARMRK) != 0);
  check("IXON", (mode.c_iflag & IXON) != 0);
  check("IXOFF", (mode.c_iflag & IXOFF) != 0);
  check("OPOST", (mode.c_oflag & OPOST) != 0);
  check("ECHO", (mode.c_lflag & ECHO) != 0);
  check("ICANON", (mode.c_lflag & ICANON) != 0);
  check("ISIG", (mode.c_lflag & ISIG) != 0);
  return found;
}

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
