#include "base/user_data.h"

#include <cstdlib>

namespace microinjection {

std::string userDataFile(const std::string& name) {
  const char* data = std::getenv("XDG_DATA_HOME");
  const char* home = std::getenv("HOME");
  const std::string base = data && *data ? data : std::string(home ? home : "/tmp") + "/.local/share";
  return base + "/cell_microinjection/" + name;
}

}  // namespace microinjection
