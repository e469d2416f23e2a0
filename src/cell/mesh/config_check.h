#pragma once

#include <string>
#include <vector>

namespace microinjection {

/// Collects what is wrong with the configuration of a mesher: key, value and what is allowed.
class ConfigCheck {
 public:
  /// `subject` begins each message.
  explicit ConfigCheck(std::string subject) : subject_(std::move(subject)) {}

  void require(bool good, const std::string& key, double value, const std::string& allowed);

  /// Radii of concentric layers, outermost first: positive, descending, and no layer (nor the innermost ball) thinner
  /// than `thinnest` times the first. False when they are not, and nothing should be held against them.
  bool requireLayers(const std::vector<double>& radii, double thinnest);

  bool good() const { return errors_.empty(); }

  /// Throws ConfigError with all errors at once.
  void finish() const;

 private:
  std::string subject_;
  std::vector<std::string> errors_;
};

bool isPositive(double value);  ///< and finite

/// "key[index].field"
std::string keyOf(const std::string& key, std::size_t index, const std::string& field = "");

}  // namespace microinjection
