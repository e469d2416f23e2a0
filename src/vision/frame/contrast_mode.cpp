#include "vision/frame/contrast_mode.h"

#include <vector>

#include "base/errors.h"

namespace microinjection {
namespace {

const std::vector<std::string> kNames = {"bright_field", "phase", "dic"};
constexpr char kUnknownName[] = "unknown";

std::vector<std::string> namesOf(bool may_be_unknown) {
  std::vector<std::string> names = kNames;
  if (may_be_unknown) names.push_back(kUnknownName);
  return names;
}

}  // namespace

const char* toText(ContrastMode mode) {
  return mode == ContrastMode::kUnknown ? kUnknownName : kNames[static_cast<int>(mode) - 1].c_str();
}

ContrastMode contrastModeOf(const std::string& text) {
  for (const ContrastMode mode :
       {ContrastMode::kUnknown, ContrastMode::kBrightField, ContrastMode::kPhase, ContrastMode::kDic}) {
    if (text == toText(mode)) return mode;
  }
  throw ConfigError("contrast mode = " + text + ": must be one of: " + join(namesOf(true), ", "));
}

void readContrastMode(ConfigReader& reader, const std::string& key, ContrastMode& mode, bool may_be_unknown) {
  std::string name = toText(mode);
  const std::vector<std::string> allowed = namesOf(may_be_unknown);
  reader.choice(key, name, allowed);
  // A wrong name is an error of the reader's, and the value stays.
  for (const std::string& known : allowed) {
    if (name == known) mode = contrastModeOf(name);
  }
}

}  // namespace microinjection
