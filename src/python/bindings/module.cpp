#include "python/bindings/module.h"

#include "base/errors.h"
#include "session/session_paths.h"

namespace py = pybind11;

PYBIND11_MODULE(_core, module) {
  using namespace microinjection;
  module.doc() = "The cell, its forces, what records and images tell of it: the part of the package that knows no ROS.";
  // The texts are those of the commands.
  py::register_exception<ConfigError>(module, "ConfigError", PyExc_ValueError);
  py::register_exception<WriteError>(module, "WriteError", PyExc_OSError);
  module.attr("__version__") = MICROINJECTION_VERSION;
  module.def("package_folder", &packageFolder);
  bindCell(module);
  bindIdentify(module);
  bindVision(module);
  bindTrial(module);
}
