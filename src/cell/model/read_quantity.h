#pragma once

#include <string>

#include "base/config_reader.h"

namespace microinjection {

/// As ConfigReader::number, with the unit in the message.
void readQuantity(ConfigReader reader, const std::string& key, double& value, const Range& range,
                  const std::string& unit, ConfigReader::Presence presence = ConfigReader::kOptional);

}  // namespace microinjection
