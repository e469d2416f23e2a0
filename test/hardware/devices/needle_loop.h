#pragma once

namespace microinjection {

constexpr double kStep = 1e-3;  // s, from one step of the needle to the next

}  // namespace microinjection
