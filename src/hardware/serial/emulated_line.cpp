#include "hardware/serial/emulated_line.h"

#include <algorithm>

namespace microinjection {

void LineTiming::put(const std::string& bytes, double time) {
  free_ = bytes_.empty() ? time : std::max(free_, time);
  for (const char value : bytes) {
    free_ += byte_time_;
    bytes_.push_back({value, free_});
  }
}

std::vector<LineTiming::Byte> LineTiming::receive(double time) {
  const auto end = std::find_if(bytes_.begin(), bytes_.end(), [&](const Byte& byte) { return byte.time > time; });
  std::vector<Byte> arrived(bytes_.begin(), end);
  bytes_.erase(bytes_.begin(), end);
  return arrived;
}

EmulatedLine::EmulatedLine(std::shared_ptr<DeviceEmulator> device, double baud, double delay)
    : device_(std::move(device)), to_device_(baud), from_device_(baud), delay_(delay) {}

std::string EmulatedLine::receive(double time) {
  if (was_cut_) device_->send(time);
  was_cut_ = false;
  for (const LineTiming::Byte& byte : to_device_.receive(time)) {
    device_->receive(std::string(1, byte.value), byte.time);
    from_device_.put(device_->send(byte.time), byte.time);
  }
  from_device_.put(device_->send(time), time);
  std::string arrived;
  for (const LineTiming::Byte& byte : from_device_.receive(time - delay_)) arrived += byte.value;
  return arrived;
}

void EmulatedLine::cut() {
  to_device_.clear();
  from_device_.clear();
  was_cut_ = true;
}

}  // namespace microinjection
