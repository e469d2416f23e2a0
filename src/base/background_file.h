#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace microinjection {

/// Writes a file from a thread of its own, for a loop that must not wait for the disk. In virtual time it has no
/// thread: each run of a session must find the same file at the same time.
class BackgroundFile {
 public:
  enum class Writing { kInBackground, kAtOnce };

  explicit BackgroundFile(std::string path, Writing writing = Writing::kInBackground);
  /// Waits until the last content is written.
  ~BackgroundFile();
  BackgroundFile(const BackgroundFile&) = delete;
  BackgroundFile& operator=(const BackgroundFile&) = delete;

  /// Has the whole file written, atomically. Only the newest content is written when the disk is slow.
  void write(std::string content);
  /// Why the last writing failed; empty: it did not, or none has ended.
  std::string error() const;
  const std::string& path() const { return path_; }

 private:
  void run();
  /// Writes the file. @returns why it failed; empty: it did not
  std::string save(const std::string& content) const;

  std::string path_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<std::string> content_;  ///< that waits
  std::string error_;
  bool ended_ = false;
  std::thread thread_;  ///< none: write() writes by itself
};

}  // namespace microinjection
