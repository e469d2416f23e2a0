#pragma once

#include <map>
#include <string>
#include <vector>

namespace microinjection {

/// A column of a table and what its numbers are multiplied with to be in SI units.
struct ForceColumn {
  std::size_t index = 0;
  double unit = 1;
};

/// Columns of time, position, deflection and force by the table's line of names; see readForceCurve.
/// `given`: quantity -> "name:unit". Position and force are always there. Throws ConfigError.
std::map<std::string, ForceColumn> findForceColumns(const std::vector<std::string>& names,
                                                    const std::map<std::string, std::string>& given,
                                                    const std::string& path);

}  // namespace microinjection
