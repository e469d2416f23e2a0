#pragma once

#include <locale>
#include <optional>
#include <sstream>
#include <string>

namespace microinjection {

/// The number in `text`, after any blanks; none if anything else is in it or it is out of range.
template <typename Number>
std::optional<Number> parseNumber(const std::string& text) {
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  Number value{};
  return in >> value && in.eof() ? std::optional<Number>(value) : std::nullopt;
}

}  // namespace microinjection
