#include "base/background_file.h"

#include <exception>
#include <utility>

#include "base/atomic_file.h"

namespace microinjection {

BackgroundFile::BackgroundFile(std::string path, Writing writing) : path_(std::move(path)) {
  if (writing == Writing::kInBackground) thread_ = std::thread([this] { run(); });
}

BackgroundFile::~BackgroundFile() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ended_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void BackgroundFile::write(std::string content) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!thread_.joinable()) {
      error_ = save(content);
      return;
    }
    content_ = std::move(content);
  }
  changed_.notify_one();
}

std::string BackgroundFile::error() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return error_;
}

std::string BackgroundFile::save(const std::string& content) const {
  try {
    writeFileAtomically(path_, content);
  } catch (const std::exception& failure) {
    return failure.what();
  }
  return "";
}

void BackgroundFile::run() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return content_ || ended_; });
    if (!content_) return;
    const std::string content = *std::exchange(content_, std::nullopt);
    lock.unlock();
    std::string error = save(content);
    lock.lock();
    error_ = std::move(error);
  }
}

}  // namespace microinjection
