#include "nodes/haptic/raw_terminal.h"

#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>

#include "base/errors.h"

namespace microinjection {

RawTerminal::RawTerminal() {
  if (!isatty(STDIN_FILENO) || tcgetattr(STDIN_FILENO, &before_) != 0) {
    throw ConfigError("the keyboard needs a terminal: start it with rosrun in one, not with roslaunch");
  }
  termios raw = before_;
  raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);  // Ctrl-C still ends the program
  raw.c_cc[VMIN] = 0;
  raw.c_cc[VTIME] = 0;
  tcsetattr(STDIN_FILENO, TCSANOW, &raw);
}

RawTerminal::~RawTerminal() {
  tcsetattr(STDIN_FILENO, TCSANOW, &before_);
  std::fputs("\n", stdout);
  std::fflush(stdout);
}

std::string RawTerminal::read() {
  std::string typed;
  pollfd input{STDIN_FILENO, POLLIN, 0};
  while (!closed_ && poll(&input, 1, 0) > 0) {
    char bytes[64];
    const ssize_t count = ::read(STDIN_FILENO, bytes, sizeof bytes);
    if (count <= 0) {
      closed_ = true;
    } else {
      typed.append(bytes, static_cast<std::size_t>(count));
    }
  }
  return typed;
}

void RawTerminal::show(const std::string& line) {
  winsize size{};
  // The size is that of standard input: standard output may be a pipe to the thread that writes to
  // the terminal (base/console_relay.h).
  const bool has_size = ioctl(STDIN_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1;
  const std::string cut = line.substr(0, has_size ? size.ws_col - 1 : 79);
  if (cut == shown_) return;
  shown_ = cut;
  std::printf("\r\x1b[K%s", cut.c_str());
  std::fflush(stdout);
}

}  // namespace microinjection
