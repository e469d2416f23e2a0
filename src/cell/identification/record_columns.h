#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/text_table.h"

namespace microinjection {

/// A column of a table and what its numbers are multiplied with to be in SI units.
struct RecordColumn {
  std::size_t index = 0;
  double unit = 1;
  std::string name;  ///< by which it was found, as "height"; empty: the user named it
};

/// What a record is about: a needle's force by its position (with time and deflection, if they are there), or the
/// length of a tongue by the pressure that draws it.
enum class RecordKind { kForce, kTongue };

/// Columns of a record's quantities by the table's titles; see readForceCurve. `given`: quantity -> "name:unit".
/// Position and force, or pressure and tongue, are always there. `notes` takes what was left out. Throws ConfigError.
std::map<std::string, RecordColumn> findRecordColumns(const TextTable& table, RecordKind kind,
                                                      const std::map<std::string, std::string>& given,
                                                      std::vector<std::string>& notes);

}  // namespace microinjection
