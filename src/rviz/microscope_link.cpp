#include "rviz/microscope_link.h"

#include <utility>

#include "rviz/session_clock.h"

namespace microinjection {
namespace {

// Images that come while rviz draws a frame: what was found belongs to one of them.
constexpr std::uint32_t kQueue = 8;

}  // namespace

MicroscopeLink::MicroscopeLink(Bus& bus) : bus_(bus) {
  findings_ = bus.subscribe<cell_microinjection::VisionState>("vision/state", 1, [this](const auto& delivery) {
    specimen_ = *delivery.message;
    pairing_.addFinding(specimen_.header.stamp.toSec(), now());
    grown_ = true;
  });
  listen(true);
}

void MicroscopeLink::listen(bool on) {
  if (on == static_cast<bool>(images_)) return;
  if (!on) {
    images_.shutdown();
    return;
  }
  images_ = bus_.subscribe<sensor_msgs::Image>("microscope/image_raw", kQueue, [this](const auto& delivery) {
    pairing_.addImage(delivery.message->header.stamp.toSec(), delivery.message, now());
    grown_ = true;
  });
}

bool MicroscopeLink::poll() {
  serveArrived(bus_);
  return std::exchange(grown_, false);
}

bool MicroscopeLink::hasSource() const { return findings_.publishers() > 0 || (images_ && images_.publishers() > 0); }

sensor_msgs::ImageConstPtr MicroscopeLink::image() const {
  return pairing_.age(now()) < kSilence ? pairing_.shown(now()).value_or(nullptr) : nullptr;
}

std::optional<cell_microinjection::VisionState> MicroscopeLink::specimen() const {
  return pairing_.hasFinding(now()) ? std::optional(specimen_) : std::nullopt;
}

}  // namespace microinjection
