#pragma once

#include <algorithm>
#include <cctype>
#include <string>

namespace microinjection {

/// A text with its ASCII letters in lower case.
inline std::string lowerCase(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

}  // namespace microinjection
