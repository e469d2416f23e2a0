#include "nodes/session_bag.h"

#include <cstdio>
#include <filesystem>

namespace microinjection {

SessionBag::SessionBag(const std::string& path) : path_(path) {
  std::filesystem::create_directories(std::filesystem::absolute(path).parent_path());
  bag_.open(path + ".active", rosbag::bagmode::Write);
  bag_.setCompression(rosbag::compression::LZ4);
}

void SessionBag::close() {
  if (!open_) return;
  open_ = false;
  bag_.close();
  if (std::rename((path_ + ".active").c_str(), path_.c_str()) != 0) ROS_ERROR_STREAM(path_ << ": cannot be renamed to");
}

}  // namespace microinjection
