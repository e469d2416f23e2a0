#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "nodes/bus/bus.h"

namespace microinjection {

/// The parameters of one node of the session, which are set before it starts. Each call waits for the master: read them
/// when the node appears, not for each message.
class SessionParameters {
 public:
  /// @param node  as "/injection_controller"
  SessionParameters(const Bus& bus, std::string node) : bus_(bus), node_(std::move(node)) {}

  /// Empty: it is not set, or no number. The second is an error().
  std::optional<double> number(const std::string& key);
  /// Empty: it is not set, or one of them is no number. The second is an error().
  std::vector<double> numbers(const std::string& key);
  /// Empty: it is not set.
  std::string text(const std::string& key) const;
  /// The values that are no numbers; empty: none.
  const std::string& error() const { return error_; }

 private:
  std::optional<double> numberOf(const std::string& key, const YAML::Node& value);

  const Bus& bus_;
  std::string node_;
  std::string error_;
};

}  // namespace microinjection
