#include "nodes/recording/session_files.h"

#include <ros/console.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <filesystem>

namespace microinjection {
namespace {

/// ns without a lost row until the disk counts as writable again: single rows may fit on a full
/// one.
constexpr std::uint64_t kSettled = 1000000000;

}  // namespace

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

SessionFiles::SessionFiles(const std::string& folder, const std::string& header, bool bag)
    : rows_(folder + "/force_depth.csv", header) {
  if (bag) bag_ = std::make_unique<SessionBag>(folder + "/session.bag");
}

void SessionFiles::step(const ros::Time& now) {
  rows_.flush();
  const std::uint64_t time = now.toNSec();
  if (!rows_.errorText().empty()) {
    error_text_ = rows_.errorText();
    failed_at_ns_ = time;
    if (!failing_) ROS_ERROR_STREAM(error_text_ << "; the session goes on, its rows are lost until there is space");
    failing_ = true;
  } else if (failing_ && (time < failed_at_ns_ || time - failed_at_ns_ > kSettled)) {
    failing_ = false;
    ROS_WARN_STREAM("force_depth.csv is written again; " << rows_.lost() << " rows are lost");
  }
}

std::vector<std::string> SessionFiles::finish() {
  std::vector<std::string> errors = {rows_.finish()};
  if (bag_) errors.push_back(bag_->close());
  errors.erase(std::remove(errors.begin(), errors.end(), ""), errors.end());
  return errors;
}

void SessionFiles::report(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  using diagnostic_msgs::DiagnosticStatus;
  status.summary(DiagnosticStatus::OK, "the session is written");
  if (rows_.lost() > 0) status.summary(DiagnosticStatus::WARN, "rows of force_depth.csv are lost");
  if (failing_) status.summary(DiagnosticStatus::ERROR, error_text_);
  if (bag_ && !bag_->errorText().empty()) status.mergeSummary(DiagnosticStatus::ERROR, bag_->errorText());
  status.add("rows written", rows_.written());
  status.add("rows lost", rows_.lost());
}

std::string localTime(const Bus& bus) {
  const std::time_t now = bus.isVirtual() ? static_cast<std::time_t>(bus.now().sec) : std::time(nullptr);
  std::tm parts{};
  bus.isVirtual() ? gmtime_r(&now, &parts) : localtime_r(&now, &parts);
  char text[40];
  std::strftime(text, sizeof(text), "%Y-%m-%dT%H:%M:%S", &parts);
  return text;
}

}  // namespace microinjection
