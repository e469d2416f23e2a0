#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace microinjection {

/// A configuration, file or argument that the user can mend. what() has one line per error, each naming the key or
/// file, the value found and what is allowed.
class ConfigError : public std::runtime_error {
 public:
  explicit ConfigError(const std::string& message) : std::runtime_error(message) {}
  explicit ConfigError(const std::vector<std::string>& messages);
};

}  // namespace microinjection
