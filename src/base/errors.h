#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace microinjection {

/// An error in a configuration, file or argument that the user can correct. what() has one line per
/// error, which names the key or file, the value found and what is allowed.
class ConfigError : public std::runtime_error {
 public:
  explicit ConfigError(const std::string& message) : std::runtime_error(message) {}
  explicit ConfigError(const std::vector<std::string>& messages);
};

/// A result could not be written. what() names the path or the standard output, and the system's
/// reason.
class WriteError : public std::runtime_error {
 public:
  WriteError(const std::string& output, const std::string& reason)
      : std::runtime_error(output + ": cannot be written: " + reason) {}
};

}  // namespace microinjection
