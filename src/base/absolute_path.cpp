#include "base/absolute_path.h"

#include <cstdlib>
#include <filesystem>

namespace microinjection {

std::string absolutePath(const std::string& path, const std::string& folder) {
  const char* home = std::getenv("HOME");
  if (home && path.rfind("~/", 0) == 0)
    return (std::filesystem::path(home) / path.substr(2)).lexically_normal().string();
  return std::filesystem::absolute(std::filesystem::path(folder) / path).lexically_normal().string();
}

}  // namespace microinjection
