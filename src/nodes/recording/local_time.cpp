#include "nodes/recording/local_time.h"

#include <ctime>

namespace microinjection {

std::string localTime(const Bus& bus) {
  const std::time_t now = bus.isVirtual() ? static_cast<std::time_t>(bus.now().sec) : std::time(nullptr);
  std::tm parts{};
  bus.isVirtual() ? gmtime_r(&now, &parts) : localtime_r(&now, &parts);
  char text[40];
  std::strftime(text, sizeof(text), "%Y-%m-%dT%H:%M:%S", &parts);
  return text;
}

}  // namespace microinjection
