#include "rviz/microscope_link.h"

#include <chrono>
#include <utility>

namespace microinjection {
namespace {

// Images that come while rviz draws a frame: what was found belongs to one of them.
constexpr std::uint32_t kQueue = 8;

/// s. The nodes of the microscope live in wall time.
double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

}  // namespace

MicroscopeLink::MicroscopeLink() {
  node_.setCallbackQueue(&queue_);
  findings_ = node_.subscribe<cell_microinjection::VisionState>(
      "vision/state", 1,
      boost::function<void(const cell_microinjection::VisionState::ConstPtr&)>([this](const auto& message) {
        specimen_ = *message;
        pairing_.addFinding(message->header.stamp.toSec(), now());
        grown_ = true;
      }));
  listen(true);
}

void MicroscopeLink::listen(bool on) {
  if (on == static_cast<bool>(images_)) return;
  if (!on) {
    images_.shutdown();
    return;
  }
  images_ = node_.subscribe<sensor_msgs::Image>(
      "microscope/image_raw", kQueue,
      boost::function<void(const sensor_msgs::ImageConstPtr&)>([this](const auto& message) {
        pairing_.addImage(message->header.stamp.toSec(), message, now());
        grown_ = true;
      }));
}

bool MicroscopeLink::poll() {
  queue_.callAvailable(ros::WallDuration(0));
  return std::exchange(grown_, false);
}

bool MicroscopeLink::hasSource() const {
  return findings_.getNumPublishers() > 0 || (images_ && images_.getNumPublishers() > 0);
}

sensor_msgs::ImageConstPtr MicroscopeLink::image() const {
  return pairing_.age(now()) < kSilence ? pairing_.shown(now()).value_or(nullptr) : nullptr;
}

std::optional<cell_microinjection::VisionState> MicroscopeLink::specimen() const {
  return pairing_.hasFinding(now()) ? std::optional(specimen_) : std::nullopt;
}

}  // namespace microinjection
