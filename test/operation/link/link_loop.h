#pragma once

namespace microinjection {

constexpr double kStep = 1e-3;   // s
constexpr double kScale = 1e-3;  // 1, metres of needle per metre of hand

}  // namespace microinjection
