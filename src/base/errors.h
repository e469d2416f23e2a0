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

/// A result that could not be written. what() names the path, or the standard output, and the system's reason.
class WriteError : public std::runtime_error {
 public:
  WriteError(const std::string& place, const std::string& reason)
      : std::runtime_error(place + ": cannot be written: " + reason) {}
};

}  // namespace microinjection
