#include "session/package_folder.h"

#include <filesystem>

namespace microinjection {

std::string packageFolder() {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  // PREFIX/lib/cell_microinjection/session, PREFIX/share/cell_microinjection
  const fs::path installed = program.parent_path().parent_path().parent_path() / "share/cell_microinjection";
  if (fs::is_directory(installed / "config", ignored)) return installed.string();
  return MICROINJECTION_PACKAGE_FOLDER;
}

}  // namespace microinjection
