#pragma once

#include <cstdint>
#include <string>

namespace microinjection {

/// Excludes other processes from one piece of work, here and on a shared file system. The lock ends
/// with this object, and with its process.
class FileLock {
 public:
  /// Tries to lock the piece `number` of the lock file `path`, which is created. Throws WriteError
  /// when the file cannot be opened.
  FileLock(const std::string& path, std::uint32_t number);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

  bool held() const { return held_; }

 private:
  int file_ = -1;
  bool held_ = false;
};

}  // namespace microinjection
