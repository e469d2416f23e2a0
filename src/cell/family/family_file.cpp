#include "cell/family/family_file.h"

#include <algorithm>
#include <filesystem>

namespace microinjection {

std::string familyDataFile(const std::string& family_file) {
  return std::filesystem::path(family_file).replace_extension(".data").string();
}

std::vector<std::string> familyFiles(const std::string& folder) {
  std::vector<std::string> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".yaml") files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace microinjection
