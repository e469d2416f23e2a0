#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/text_table.h"

namespace microinjection {

/// A column of a table and what its numbers are multiplied with to be in SI units.
struct ForceColumn {
  std::size_t index = 0;
  double unit = 1;
  std::string name;  ///< by which it was found, as "height"; empty: the user named it
};

/// Columns of time, position, deflection and force by the table's titles; see readForceCurve.
/// `given`: quantity -> "name:unit". Position and force are always there. `notes` takes what was left out. Throws
/// ConfigError.
std::map<std::string, ForceColumn> findForceColumns(const TextTable& table,
                                                    const std::map<std::string, std::string>& given,
                                                    std::vector<std::string>& notes);

}  // namespace microinjection
