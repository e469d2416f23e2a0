#pragma once

#include <string>

namespace microinjection {

/// A text as one field of a CSV row (RFC 4180): as it is, or in quotes, with each of its own quotes
/// doubled, when it has a comma, a quote or the end of a line.
std::string csvField(const std::string& text);

}  // namespace microinjection
