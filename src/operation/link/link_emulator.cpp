#include "operation/link/link_emulator.h"

namespace microinjection {

LinkConditions LinkConditions::read(ConfigReader reader) {
  LinkConditions conditions;
  int seed = static_cast<int>(conditions.seed);
  reader.number("delay", conditions.delay, Range::closed(0, 10));
  reader.number("jitter", conditions.jitter, Range::closed(0, 10));
  reader.number("loss", conditions.loss, Range::closed(0, 1));
  reader.integer("seed", seed, Range::nonNegative());
  conditions.seed = static_cast<unsigned>(seed);
  return conditions;
}

}  // namespace microinjection
