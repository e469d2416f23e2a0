#pragma once

#include <string>
#include <vector>

#include "base/config_errors.h"

namespace microinjection {

/// Requires radii of concentric layers, outermost first: positive, descending, and no layer (nor
/// the innermost ball) thinner than `thinnest` times the first. Returns false when they are not;
/// the caller must not use them then.
bool requireLayerRadii(const std::vector<double>& radii, double thinnest, ConfigErrors& errors);

/// "key[index].field"
std::string keyOf(const std::string& key, std::size_t index, const std::string& field = "");

}  // namespace microinjection
