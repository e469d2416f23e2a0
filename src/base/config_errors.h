#pragma once

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "base/errors.h"
#include "base/range.h"

namespace microinjection {

/// Collects the errors of a configuration and reports them all at once: key, value and what is
/// allowed.
class ConfigErrors {
 public:
  /// `subject` begins each message; it may be empty.
  explicit ConfigErrors(const std::string& subject = "") : prefix_(subject.empty() ? "" : subject + ": ") {}

  /// Adds "KEY = VALUE UNIT: must be ALLOWED" unless `good`. `unit` begins with a space, or is
  /// empty.
  template <typename Value>
  void require(bool good, const std::string& key, const Value& value, const std::string& unit,
               const std::string& allowed) {
    if (good) return;
    std::ostringstream message;
    message << key << " = " << value << unit << ": must be " << allowed;
    add(message.str());
  }
  void require(const Range& range, const std::string& key, double value, const std::string& unit = "") {
    require(range.contains(value), key, value, unit, "in " + range.text() + unit);
  }
  /// Requires one of `names`.
  void requireOneOf(const std::vector<std::string>& names, const std::string& key, const std::string& value) {
    const bool known = std::find(names.begin(), names.end(), value) != names.end();
    require(known, key, value, "", "one of: " + join(names, ", "));
  }
  void add(const std::string& message) { messages_.push_back(prefix_ + message); }

  bool good() const { return messages_.empty(); }
  const std::vector<std::string>& messages() const { return messages_; }
  /// Throws ConfigError when there are errors.
  void throwAny() const {
    if (!good()) throw ConfigError(messages_);
  }

 private:
  std::string prefix_;
  std::vector<std::string> messages_;
};

}  // namespace microinjection
