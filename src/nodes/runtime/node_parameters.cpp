#include "nodes/runtime/node_parameters.h"

namespace microinjection {

ConfigReader parameterReader(const Bus& bus) {
  YAML::Node parameters = bus.parameter("~");
  if (!parameters.IsMap()) parameters = YAML::Node(YAML::NodeType::Map);
  parameters.remove("diagnostic_period");
  return ConfigReader(parameters, bus.name());
}

}  // namespace microinjection
