#include "hardware/serial/line_timing.h"

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

}  // namespace microinjection
