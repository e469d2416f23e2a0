#include "cell/estimation/cell_estimator.h"

namespace microinjection {

void CellEstimatorConfig::read(ConfigReader& reader) {
  reader.number("modulus_deviation", modulus_deviation, Range::closed(0.01, 3));
  reader.number("next_deviation", next_deviation, Range::closed(0.01, 3));
  reader.number("contact_deviation", contact_deviation, Range::closed(1e-9, 20e-6));
  reader.number("offset_deviation", offset_deviation, Range::positive());
  reader.number("sensor_noise", sensor_noise, Range::positive());
  reader.number("sensor_floor", sensor_floor, Range::positive());
  reader.number("force_error", force_error, Range::closed(0, 0.2));
  reader.number("converged_interval", converged_interval, Range::closed(0.001, 0.5));
  reader.number("misfit", misfit, Range::closed(0.001, 1));
  reader.number("drift_limit", drift_limit, Range::positive());
  ConfigReader samples = reader.section("history");
  history.read(samples);
}

}  // namespace microinjection
