#include "base/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "base/errors.h"

namespace microinjection {
namespace {

bool writeAll(int file, const std::string& content) {
  size_t done = 0;
  while (done < content.size()) {
    const ssize_t count = ::write(file, content.data() + done, content.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return false;
    done += static_cast<size_t>(count);
  }
  return true;
}

/// Closes the file. Throws WriteError when that fails, or when an earlier step failed (not `good`),
/// whose reason errno holds.
void finish(int file, bool good, const std::string& path) {
  int reason = errno;
  if (::close(file) != 0 && good) good = false, reason = errno;
  if (!good) throw WriteError(path, std::strerror(reason));
}

void makeFolder(const std::filesystem::path& folder, const std::string& path) {
  std::error_code error;
  if (!folder.empty()) std::filesystem::create_directories(folder, error);
  if (error) throw WriteError(path, error.message());
}

/// Writes a complete new file beside `path` and returns its name. Throws WriteError, which names
/// `path`, and then leaves no file.
std::string writeTemporary(const std::string& path, const std::string& content) {
  std::string temporary = path + ".XXXXXX";
  const int file = ::mkstemp(temporary.data());
  if (file < 0) throw WriteError(path, std::strerror(errno));
  // mkstemp makes a file that only its owner can read. The result gets the permissions of the
  // umask.
  const mode_t mask = ::umask(0);
  ::umask(mask);
  try {
    finish(file, ::fchmod(file, 0666 & ~mask) == 0 && writeAll(file, content) && ::fsync(file) == 0, path);
  } catch (const WriteError&) {
    ::unlink(temporary.c_str());
    throw;
  }
  return temporary;
}

}  // namespace

void writeFileAtomically(const std::string& path, const std::string& content) {
  std::error_code error;
  if (!std::filesystem::exists(path, error) || std::filesystem::is_regular_file(path, error)) {
    replaceFileAtomically(path, content);
    return;
  }
  const int file = ::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
  if (file < 0) throw WriteError(path, std::strerror(errno));
  finish(file, writeAll(file, content), path);
}

void replaceFileAtomically(const std::string& path, const std::string& content) {
  makeFolder(std::filesystem::path(path).parent_path(), path);
  const std::string temporary = writeTemporary(path, content);
  if (std::rename(temporary.c_str(), path.c_str()) == 0) return;
  const int reason = errno;
  ::unlink(temporary.c_str());
  throw WriteError(path, std::strerror(reason));
}

void requireWritableFolder(const std::string& folder) {
  constexpr std::size_t kBlock = 4096;  // an empty file would fit on a full file system, so a block of it is written
  makeFolder(folder, folder);
  ::unlink(writeTemporary(folder + "/writable", std::string(kBlock, ' ')).c_str());
}

}  // namespace microinjection
