#include "hardware/serial/fault.h"

#include <cmath>
#include <map>

#include "base/errors.h"
#include "base/parse_number.h"

namespace microinjection {
namespace {

constexpr char kAllowed[] =
    "KIND[:VALUE][@TIME] with silence:SECONDS, drop:BYTES, deaf:BYTES, garble:BYTES, error:CODE or interrupt; TIME in "
    "s";

double number(const std::string& fault, const std::string& text, bool whole) {
  const auto value = parseNumber<double>(text);
  if (!value || *value < 0 || (whole && (*value != std::floor(*value) || *value < 1))) {
    throw ConfigError("fault = " + fault + ": \"" + text + "\" must be " +
                      (whole ? "a whole number of at least 1" : "a number of at least 0, s"));
  }
  return *value;
}

}  // namespace

Fault parseFault(const std::string& text) {
  static const std::map<std::string, Fault::Kind> kinds{
      {"silence", Fault::Kind::kSilence}, {"drop", Fault::Kind::kDrop},   {"deaf", Fault::Kind::kDeaf},
      {"garble", Fault::Kind::kGarble},   {"error", Fault::Kind::kError}, {"interrupt", Fault::Kind::kInterrupt}};
  Fault fault;
  const std::size_t at = text.find('@');
  const std::string what = text.substr(0, at);
  if (at != std::string::npos) fault.time = number(text, text.substr(at + 1), false);
  const std::size_t colon = what.find(':');
  const auto found = kinds.find(what.substr(0, colon));
  const std::string value = colon == std::string::npos ? "" : what.substr(colon + 1);
  if (found == kinds.end() || value.empty() != (found->second == Fault::Kind::kInterrupt) ||
      (value.empty() && colon != std::string::npos)) {
    throw ConfigError("fault = " + text + ": must be " + kAllowed);
  }
  fault.kind = found->second;
  if (fault.kind == Fault::Kind::kError) {
    fault.code = value;
  } else if (!value.empty()) {
    fault.amount = number(text, value, fault.kind != Fault::Kind::kSilence);
  }
  return fault;
}

}  // namespace microinjection
