#include "cell/model/read_quantity.h"

#include <cmath>
#include <limits>

namespace microinjection {

void readQuantity(ConfigReader reader, const std::string& key, double& value, const Range& range,
                  const std::string& unit, ConfigReader::Presence presence) {
  double read = std::numeric_limits<double>::quiet_NaN();
  reader.number(key, read, Range::finite(), presence);
  if (std::isnan(read)) return;
  if (!range.contains(read)) {
    return reader.error(key, "must be a number in " + range.text() + (unit.empty() ? "" : " " + unit));
  }
  value = read;
}

}  // namespace microinjection
