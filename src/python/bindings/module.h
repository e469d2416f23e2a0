#pragma once

#include <pybind11/pybind11.h>

namespace microinjection {

void bindCell(pybind11::module_& module);
void bindIdentify(pybind11::module_& module);
void bindVision(pybind11::module_& module);
void bindTrial(pybind11::module_& module);

}  // namespace microinjection
