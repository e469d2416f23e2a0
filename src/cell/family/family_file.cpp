#include "cell/family/family_file.h"

#include <filesystem>

namespace microinjection {

std::string familyDataFile(const std::string& family_file) {
  return std::filesystem::path(family_file).replace_extension(".data").string();
}

}  // namespace microinjection
