#include "nodes/recording/session_bag.h"

#include <ros/console.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

namespace microinjection {

SessionBag::SessionBag(const std::string& path) : path_(path), bag_(std::make_unique<rosbag::Bag>()) {
  std::filesystem::create_directories(std::filesystem::absolute(path).parent_path());
  bag_->open(path + ".active", rosbag::bagmode::Write);
  bag_->setCompression(rosbag::compression::LZ4);
}

void SessionBag::abort(const std::string& what, int reason) {
  error_text_ = path_ + ".active: cannot be written: " + what;
  if (reason != 0) error_text_ += std::string(": ") + std::strerror(reason);
  ROS_ERROR_STREAM(error_text_ << "; the bag ends here, the session goes on");
  // A failed bag is not destroyed: its destructor writes again, and its exception would end the
  // program.
  static_cast<void>(bag_.release());
}

std::string SessionBag::close() {
  if (!bag_) return error_text_;
  try {
    errno = 0;
    bag_->close();
  } catch (const std::exception& error) {
    const int reason = errno;
    abort(error.what(), reason);
    return error_text_;
  }
  bag_.reset();
  if (std::rename((path_ + ".active").c_str(), path_.c_str()) != 0)
    error_text_ = path_ + ".active: cannot be renamed: " + std::strerror(errno);
  return error_text_;
}

}  // namespace microinjection
