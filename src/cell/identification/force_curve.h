#pragma once

#include <map>
#include <string>
#include <vector>

namespace microinjection {

/// A record of a needle that is pushed into a cell, sample by sample.
struct ForceCurve {
  std::vector<double> time;        ///< s
  std::vector<double> position;    ///< m, of the tip along its axis, growing into the cell; its zero is arbitrary
  std::vector<double> force;       ///< N, of the cell on the tip, growing with the depth; with any offset
  double drag = 0;                 ///< N, see dragOf(): no smaller force is that of a cell
  bool timed = true;               ///< else `time` counts samples
  std::vector<std::string> notes;  ///< what was done to the record, for the user

  std::size_t size() const { return force.size(); }
};

/// Least noise over the range of a record's forces: a record without noise is divided by it.
constexpr double kLeastRelativeNoise = 1e-5;

struct ForceCurveConfig {
  /// Column (name or number from 1) and unit of time, position, deflection and force, as "name:unit".
  /// What is not named is searched by its name; see readForceCurve.
  std::map<std::string, std::string> columns;
  /// Whose the position is: tip, base (of a lever that bends), or auto: by the column's name.
  std::string position_of = "auto";
  double spring_constant = 0;  ///< N/m, of the lever, for the deflection of a base; 0: not known
  std::string from, to;        ///< first and last row (12, from 1) or time (1.5s) that is used; empty: the ends
  std::string segment;         ///< of the column `segment`, that is used; empty: the approach
  bool whole = false;          ///< also what is no way in
};

/// Reads columns of a table (base/text_table.h) by their names. Names begin with time or t; position, tip, depth,
/// indentation, height or z; deflection; force or f, and end with the unit: force_nN, "height (um)", z[m], "time / s".
/// The position of a lever's base (height, z) is made that of the tip by the deflection, which is a column or the force
/// over the spring constant; from a tip, depth or indentation nothing is taken off. Rows without a number are left out;
/// sign and direction are found from the record, because laboratories differ in them. Throws ConfigError that names
/// file, column and what is allowed.
ForceCurve readForceCurve(const std::string& path, const ForceCurveConfig& config);

/// Means of neighbouring samples, so that at most `count` are left.
ForceCurve averaged(const ForceCurve& curve, std::size_t count);

}  // namespace microinjection
