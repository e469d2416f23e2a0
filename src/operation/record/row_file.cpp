#include "operation/record/row_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>

namespace microinjection {
namespace {

/// Writes at `offset`. Returns the number of written bytes; when some are missing, errno has the
/// reason.
std::size_t writeAt(int file, const std::string& text, std::uint64_t offset) {
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t count = ::pwrite(file, text.data() + done, text.size() - done, static_cast<off_t>(offset + done));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    done += static_cast<std::size_t>(count);
  }
  return done;
}

std::uint64_t linesIn(const std::string& text) {
  return static_cast<std::uint64_t>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace

RowFile::RowFile(std::string path, std::string header) : path_(std::move(path)), header_(std::move(header)) {
  const std::string active = path_ + ".active";
  const std::filesystem::path directory = std::filesystem::path(path_).parent_path();
  std::error_code error;
  if (!directory.empty()) std::filesystem::create_directories(directory, error);
  if (error) throw std::runtime_error(active + ": cannot be written: " + error.message());
  file_ = ::open(active.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file_ < 0) throw std::runtime_error(active + ": cannot be written: " + std::strerror(errno));
  flush();
}

RowFile::~RowFile() {
  if (file_ < 0) return;
  flush();
  ::close(file_);
}

void RowFile::flush() {
  if (file_ < 0 || (rows_.empty() && size_ > 0)) return;
  const std::string text = (size_ == 0 ? header_ : "") + rows_;
  rows_.clear();
  errno = 0;
  const std::size_t done = writeAt(file_, text, size_);
  if (done == text.size()) {
    written_ += linesIn(text) - (size_ == 0 ? 1 : 0);
    size_ += done;
    error_text_.clear();
    return;
  }
  reason_ = std::strerror(errno);
  error_text_ = path_ + ".active: cannot be written: " + reason_;
  drop(done, text);
}

/// The first `kept` bytes of `text` are in the file: their whole lines stay, the rest is lost.
void RowFile::drop(std::size_t kept, const std::string& text) {
  const std::string lines = text.substr(0, text.substr(0, kept).rfind('\n') + 1);
  const std::uint64_t heading = size_ == 0 ? 1 : 0, count = linesIn(lines);
  written_ += std::max(count, heading) - heading;
  lost_ += linesIn(text) - std::max(count, heading);
  size_ += lines.size();
  // When this fails, the next rows overwrite the incomplete one, since they are written at `size_`.
  [[maybe_unused]] const int result = ::ftruncate(file_, static_cast<off_t>(size_));
}

std::string RowFile::close() {
  const bool cut = ::ftruncate(file_, static_cast<off_t>(size_)) != 0;
  int reason = errno;
  bool good = !cut && ::fsync(file_) == 0;
  if (!cut && !good) reason = errno;
  if (::close(std::exchange(file_, -1)) != 0 && good) good = false, reason = errno;
  return good ? "" : path_ + ".active: cannot be written: " + std::strerror(reason);
}

std::string RowFile::finish() {
  if (file_ < 0) return "";
  flush();
  if (size_ == 0) {
    close();
    return error_text_ + "; " + std::to_string(lost_) + " rows are lost, and there is no table";
  }
  std::string error = close();
  if (std::rename((path_ + ".active").c_str(), path_.c_str()) != 0) {
    return path_ + ".active: cannot be renamed: " + std::strerror(errno);
  }
  if (error.empty() && lost_ > 0) error = path_ + ": " + std::to_string(lost_) + " rows are lost: " + reason_;
  return error;
}

}  // namespace microinjection
