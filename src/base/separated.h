#pragma once

#include <string>
#include <vector>

namespace microinjection {

/// The items between the separators of a text, as they stand: one more than there are separators.
inline std::vector<std::string> separated(const std::string& text, char separator = ',') {
  std::vector<std::string> items;
  for (std::size_t from = 0;;) {
    const std::size_t end = text.find(separator, from);
    items.push_back(text.substr(from, end - from));
    if (end == std::string::npos) return items;
    from = end + 1;
  }
}

}  // namespace microinjection
