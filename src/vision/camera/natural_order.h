#pragma once

#include <string>

namespace microinjection {

/// Whether `a` comes before `b` when each run of digits counts as one whole number: stack0.2 before
/// stack0.10. A total order: names that differ only in leading zeros are ordered as text.
bool naturalLess(const std::string& a, const std::string& b);

}  // namespace microinjection
