#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace microinjection {

std::string join(const std::vector<std::string>& texts, const std::string& separator);

/// An error that the user can correct.
class UserError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// An error in a configuration, file or argument. what() has one line per error, which names the
/// key or file, the value found and what is allowed.
class ConfigError : public UserError {
 public:
  explicit ConfigError(const std::string& message) : UserError(message) {}
  explicit ConfigError(const std::vector<std::string>& messages);
};

/// A result could not be written. what() names the path or the standard output, and the system's
/// reason.
class WriteError : public UserError {
 public:
  WriteError(const std::string& output, const std::string& reason)
      : UserError(output + ": cannot be written: " + reason) {}
};

}  // namespace microinjection
