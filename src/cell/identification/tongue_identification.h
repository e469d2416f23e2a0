#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "base/text_table.h"
#include "cell/identification/identification.h"
#include "cell/model/scene.h"

namespace microinjection {

/// Tongues that suction has drawn from a cell, measured in images.
struct TongueRecord {
  std::vector<double> pressure;    ///< Pa, gauge, at most 0
  std::vector<double> length;      ///< m, from any fixed place on the pipette's axis, growing into the bore
  std::vector<std::string> notes;  ///< what was done to the record, for the user
};

/// Takes a table with the columns pressure (suction, p) and tongue (tongue_length, aspirated_length, projection,
/// length) and their units: pressure_Pa, "suction (kPa)", tongue_um; `columns` names others, as for readForceCurve.
/// Pressures are suctions whatever their sign is, as long as all have the same one. Throws ConfigError that names file,
/// column and what is allowed.
TongueRecord readTongueRecord(const TextTable& table, const std::map<std::string, std::string>& columns);

/// Tongue length over the cell's radius as a function of suction over the modulus of the outermost layer, of one scene:
/// geometry, Poisson's ratios and the ratios of the layers' moduli. Solved once on one mesh (tongueCurve), then a cubic
/// spline: the modulus only stretches it along the suction.
class TongueShape {
 public:
  /// Solves; seconds. Throws ConfigError as convergedTongues(), or when not even a weak suction has a solution.
  explicit TongueShape(const Scene& scene);
  /// From lengths that are known: two vectors of one size, suctions ascending from 0, four or more. Throws
  /// std::invalid_argument otherwise. `error`: relative, of the lengths' rise.
  TongueShape(const std::vector<double>& suctions, const std::vector<double>& lengths, double error);

  double strongest() const { return suctions_[suctions_.size() - 1]; }  ///< beyond it the cell has no equilibrium
  double error() const { return error_; }
  /// @pre 0 <= suction <= strongest()
  double length(double suction) const;

 private:
  Eigen::VectorXd suctions_, lengths_, curvature_;
  double error_ = 0;
};

/// The outermost layer's modulus by which the scene's cell has these tongues, with an interval of 95 % that holds noise
/// and the solution's own error. Where the record's lengths begin is an unknown, too, because a lip's plane is seen to
/// a pixel at best; so the modulus is known by how the tongue grows. Least squares; the interval is that of the profile
/// likelihood with the noise from the residuals (F distribution of 1 and n - 2).
/// Throws ConfigError when there are fewer than 4 samples or 3 pressures, or the tongue does not grow with the suction.
Identification identifyTongue(const TongueRecord& record, const Scene& scene, const TongueShape& shape);

}  // namespace microinjection
