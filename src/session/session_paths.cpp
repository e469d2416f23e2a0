#include "session/session_paths.h"

#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>

namespace microinjection {
namespace {

namespace fs = std::filesystem;

/// The file that this code is in: of a library that is loaded (Python's module), its own; else the running program's.
fs::path thisFile() {
  std::error_code ignored;
  Dl_info info{};
  const bool found = dladdr(reinterpret_cast<const void*>(&thisFile), &info) != 0 && info.dli_fname;
  const fs::path loaded = found ? fs::path(info.dli_fname) : fs::path();
  return loaded.extension() == ".so" ? fs::canonical(loaded, ignored) : fs::read_symlink("/proc/self/exe", ignored);
}

}  // namespace

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

std::string packageFolder() {
  // PREFIX/lib/cell_microinjection/session, or PREFIX/lib/python3/dist-packages/cell_microinjection/_core.so, and
  // PREFIX/share/cell_microinjection.
  std::error_code ignored;
  for (fs::path folder = thisFile().parent_path(); folder.has_relative_path(); folder = folder.parent_path()) {
    const fs::path installed = folder / "share/cell_microinjection";
    if (fs::is_directory(installed / "config", ignored)) return installed.string();
  }
  return MICROINJECTION_PACKAGE_FOLDER;
}

}  // namespace microinjection
