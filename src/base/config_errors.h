#pragma once

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "base/errors.h"

namespace microinjection {

/// Collects what is wrong with a configuration, to tell it all at once.
class ConfigErrors {
 public:
  /// "KEY = VALUE UNIT: must be ALLOWED" unless `good`. `unit` begins with a space, or is empty.
  template <typename Value>
  void require(bool good, const std::string& key, const Value& value, const std::string& unit,
               const std::string& allowed) {
    if (good) return;
    std::ostringstream message;
    message << key << " = " << value << unit << ": must be " << allowed;
    add(message.str());
  }
  /// Requires one of `names`.
  void requireOneOf(const std::vector<std::string>& names, const std::string& key, const std::string& value) {
    std::string all;
    for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
    require(std::find(names.begin(), names.end(), value) != names.end(), key, value, "", "one of: " + all);
  }
  void add(const std::string& message) { messages_.push_back(message); }

  const std::vector<std::string>& messages() const { return messages_; }
  /// Throws ConfigError when there are some.
  void throwAny() const {
    if (!messages_.empty()) throw ConfigError(messages_);
  }

 private:
  std::vector<std::string> messages_;
};

}  // namespace microinjection
