#include "base/paths.h"

#include <cstdlib>
#include <filesystem>

namespace microinjection {

std::string userDataFile(const std::string& name) {
  const char* data = std::getenv("XDG_DATA_HOME");
  const char* home = std::getenv("HOME");
  const std::string base = data && *data ? data : std::string(home ? home : "/tmp") + "/.local/share";
  return base + "/cell_microinjection/" + name;
}

std::string absolutePath(const std::string& path, const std::string& folder) {
  const char* home = std::getenv("HOME");
  if (home && path.rfind("~/", 0) == 0)
    return (std::filesystem::path(home) / path.substr(2)).lexically_normal().string();
  return std::filesystem::absolute(std::filesystem::path(folder) / path).lexically_normal().string();
}

}  // namespace microinjection
