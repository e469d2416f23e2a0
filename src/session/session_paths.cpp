#include "session/session_paths.h"

#include <cstdlib>
#include <filesystem>

namespace microinjection {

namespace fs = std::filesystem;

std::string pathOfFileOrName(const std::string& text, const std::string& folder, const std::string& package,
                             const std::string& below) {
  if (text.find_first_of("/.") != std::string::npos) return absolutePath(text, folder);
  return package + "/" + below + "/" + text + ".yaml";
}

bool isFile(const std::string& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

std::string runtimeFolder() {
  const char* folder = std::getenv("XDG_RUNTIME_DIR");
  return folder && *folder ? folder : "/tmp";
}

}  // namespace microinjection
