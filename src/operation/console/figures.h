#pragma once

#include <string>

namespace microinjection {

/// A value in SI units with fixed decimals, so that the text keeps its width; "-" if not finite.
std::string figure(double value, double unit, int decimals);

/// The same in millionths: micro(1.25e-6, 2) is "1.25".
inline std::string micro(double value, int decimals) { return figure(value, 1e-6, decimals); }

}  // namespace microinjection
