#pragma once

#include <string>

namespace microinjection {

/// Colour of a lamp of the console. Grey: nothing is known, or nothing has to be known.
enum class Light { kGrey, kGreen, kYellow, kRed };

/// A lamp with its reason, for people.
struct Lamp {
  Light light = Light::kGrey;
  std::string text;
};

}  // namespace microinjection
