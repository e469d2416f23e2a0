#include "base/errors.h"

namespace microinjection {
namespace {

std::string join(const std::vector<std::string>& messages) {
  std::string all;
  for (const std::string& message : messages) all += (all.empty() ? "" : "\n") + message;
  return all;
}

}  // namespace

ConfigError::ConfigError(const std::vector<std::string>& messages) : ConfigError(join(messages)) {}

}  // namespace microinjection
