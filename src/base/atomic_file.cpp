#include "base/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace microinjection {
namespace {

[[noreturn]] void fail(const std::string& path, const std::string& reason) {
  throw std::runtime_error(path + ": cannot be written: " + reason);
}

bool writeAll(int file, const std::string& content) {
  size_t done = 0;
  while (done < content.size()) {
    const ssize_t count = ::write(file, content.data() + done, content.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return false;
    done += static_cast<size_t>(count);
  }
  return ::fsync(file) == 0;
}

}  // namespace

void writeFileAtomically(const std::string& path, const std::string& content) {
  const std::filesystem::path directory = std::filesystem::path(path).parent_path();
  std::error_code error;
  if (!directory.empty()) std::filesystem::create_directories(directory, error);
  if (error) fail(path, error.message());

  if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error)) {
    // A device or a pipe is written to, not replaced.
    std::ofstream out(path, std::ios::binary);
    if (!out.write(content.data(), static_cast<std::streamsize>(content.size())).flush()) fail(path, "write failed");
    return;
  }

  std::string temporary = path + ".XXXXXX";
  const int file = ::mkstemp(temporary.data());
  if (file < 0) fail(path, std::strerror(errno));
  // mkstemp keeps the file to its owner; a result is for everybody that the umask allows.
  const mode_t mask = ::umask(0);
  ::umask(mask);
  bool good = ::fchmod(file, 0666 & ~mask) == 0 && writeAll(file, content);
  int reason = errno;
  if (::close(file) != 0 && good) good = false, reason = errno;
  if (good && std::rename(temporary.c_str(), path.c_str()) != 0) good = false, reason = errno;
  if (good) return;
  ::unlink(temporary.c_str());
  fail(path, std::strerror(reason));
}

}  // namespace microinjection
