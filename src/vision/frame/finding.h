#pragma once

#include <string>

namespace microinjection {

/// What a detector claims. kUncertain comes with values that must not be used without a second
/// witness; kNotFound has none.
enum class Verdict { kFound, kUncertain, kNotFound };

/// A verdict and its reason in plain words. The reason is empty when something was found.
struct Finding {
  Verdict verdict = Verdict::kNotFound;
  std::string reason = "nothing was searched";

  static Finding found() { return {Verdict::kFound, ""}; }
  static Finding uncertain(const std::string& reason) { return {Verdict::kUncertain, reason}; }
  static Finding notFound(const std::string& reason) { return {Verdict::kNotFound, reason}; }
  bool isFound() const { return verdict == Verdict::kFound; }
  bool hasValues() const { return verdict != Verdict::kNotFound; }
};

/// "found", "uncertain" or "not found".
inline const char* nameOf(Verdict verdict) {
  return verdict == Verdict::kFound ? "found" : verdict == Verdict::kUncertain ? "uncertain" : "not found";
}

}  // namespace microinjection
