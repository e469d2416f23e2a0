#include "base/file_lock.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "base/errors.h"

namespace microinjection {

FileLock::FileLock(const std::string& path, std::uint32_t number) {
  file_ = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file_ < 0) throw WriteError(path, std::strerror(errno));
  struct flock piece = {};
  piece.l_type = F_WRLCK;
  piece.l_whence = SEEK_SET;
  piece.l_start = number;
  piece.l_len = 1;
  held_ = fcntl(file_, F_OFD_SETLK, &piece) == 0;
}

FileLock::~FileLock() { close(file_); }

}  // namespace microinjection
