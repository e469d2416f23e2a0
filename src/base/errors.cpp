#include "base/errors.h"

namespace microinjection {

std::string join(const std::vector<std::string>& texts, const std::string& separator) {
  std::string all;
  for (const std::string& text : texts) all += (all.empty() ? "" : separator) + text;
  return all;
}

ConfigError::ConfigError(const std::vector<std::string>& messages) : ConfigError(join(messages, "\n")) {}

}  // namespace microinjection
