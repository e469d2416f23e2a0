#include "hardware/serial/pseudo_terminal.h"

#include <fcntl.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "base/errors.h"

namespace microinjection {
namespace {

[[noreturn]] void fail(const std::string& what) { throw ConfigError(what + ": " + std::strerror(errno)); }

}  // namespace

PseudoTerminal::PseudoTerminal(const std::string& link) : link_(link) { connect(); }
PseudoTerminal::~PseudoTerminal() { disconnect(); }

void PseudoTerminal::connect() {
  disconnect();
  master_ = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (master_ < 0 || grantpt(master_) != 0 || unlockpt(master_) != 0) fail("pseudo-terminal");
  std::array<char, 256> name{};
  if (ptsname_r(master_, name.data(), name.size()) != 0) fail("pseudo-terminal");
  slave_ = name.data();
  kept_open_ = ::open(slave_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  termios mode{};
  if (kept_open_ < 0 || tcgetattr(kept_open_, &mode) != 0) fail(slave_);
  cfmakeraw(&mode);  // bytes unchanged: no echo, no conversion of line ends
  if (tcsetattr(kept_open_, TCSANOW, &mode) != 0) fail(slave_);
  std::error_code error;
  const std::filesystem::file_status there = std::filesystem::symlink_status(link_, error);
  if (std::filesystem::exists(there) && !std::filesystem::is_symlink(there)) {
    throw ConfigError("link = " + link_ + ": must be free, or a link; there is a file");
  }
  // Renaming replaces an old link without a moment in which there is none.
  const std::string fresh = link_ + "." + std::to_string(getpid());
  if (symlink(slave_.c_str(), fresh.c_str()) != 0) fail("link = " + link_);
  if (rename(fresh.c_str(), link_.c_str()) != 0) fail("link = " + link_);
}

void PseudoTerminal::disconnect() {
  if (master_ < 0) return;
  std::error_code error;
  if (std::filesystem::read_symlink(link_, error) == slave_) std::filesystem::remove(link_, error);
  ::close(kept_open_);
  ::close(master_);
  kept_open_ = master_ = -1;
}

std::string PseudoTerminal::read() {
  std::string result;
  std::array<char, 4096> buffer;
  while (master_ >= 0) {
    const ssize_t size = ::read(master_, buffer.data(), buffer.size());
    if (size <= 0) break;
    result.append(buffer.data(), static_cast<std::size_t>(size));
  }
  return result;
}

void PseudoTerminal::write(const std::string& bytes) {
  std::size_t done = 0;
  while (master_ >= 0 && done < bytes.size()) {
    const ssize_t size = ::write(master_, bytes.data() + done, bytes.size() - done);
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) break;
    done += static_cast<std::size_t>(size);
  }
}

}  // namespace microinjection
