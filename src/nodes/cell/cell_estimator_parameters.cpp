#include "nodes/cell/cell_estimator_parameters.h"

#include "nodes/runtime/node_parameters.h"

namespace microinjection {

CellEstimatorParameters CellEstimatorParameters::read(const Bus& bus) {
  CellEstimatorParameters parameters;
  ConfigReader reader = parameterReader(bus);
  reader.path("scene", parameters.scene, ConfigReader::kRequired);
  reader.path("families", parameters.families, ConfigReader::kRequired);
  reader.number("rate", parameters.rate, Range::closed(50, 5000));
  reader.number("update_period", parameters.update_period, Range::closed(0.005, 1));
  reader.number("needle_timeout", parameters.needle_timeout, Range::positive());
  reader.number("force_timeout", parameters.force_timeout, Range::positive());
  reader.number("controller_timeout", parameters.controller_timeout, Range::positive());
  reader.number("largest_tilt", parameters.largest_tilt, Range::closed(0, 0.2));
  reader.number("largest_speed", parameters.largest_speed, Range::positive());
  reader.number("largest_force", parameters.largest_force, Range::positive());
  reader.number("largest_sideways", parameters.largest_sideways, Range::positive());
  reader.number("clear_distance", parameters.clear_distance, Range::positive());
  reader.boolean("serve", parameters.serve);
  parameters.served.read(reader);
  reader.number("puncture_deviation", parameters.puncture_deviation, Range::closed(0, 2));
  ConfigReader image = reader.section("image");
  image.boolean("use", parameters.images);
  parameters.image.read(image);
  ConfigReader estimator = reader.section("estimator");
  parameters.estimator.read(estimator);
  reader.finish();
  return parameters;
}

}  // namespace microinjection
