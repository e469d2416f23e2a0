#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cell/identification/curve_fit.h"
#include "cell/identification/curve_model.h"
#include "cell/identification/rival_test.h"

namespace microinjection {

/// A parameter that was found, SI units.
struct Estimate {
  std::string name, unit;
  double value = 0;
  double low = 0, high = 0;  ///< interval of 95 %
  bool bounded = true;       ///< else the record does not bound it on one side: the border of the search is given
};

/// What a record says about a cell under one model.
struct Identification {
  std::string model;  ///< one line
  std::vector<Estimate> estimates;
  double noise = 0;                   ///< N, robust deviation of the residuals
  double independent = 0;             ///< number of independent samples
  double deviation = 0;               ///< N, rms of the residuals without the largest fiftieth
  double misfit = 0;                  ///< N, rms of the residuals' smooth part in contact: what the model cannot follow
  double scatter = 0;                 ///< N, what noise alone would leave of it
  double size = 0;                    ///< N, of the cell's force at the deepest sample
  double depth = 0;                   ///< m, of the deepest sample
  std::vector<std::string> warnings;  ///< what cannot be told apart, what is out of range
  Eigen::VectorXd residuals;          ///< N, of each sample
  std::optional<RivalComparison> rivals;

  /// Whether the model follows the record: the smooth part of the residuals is small, and no other cell
  /// follows it clearly better.
  bool consistent() const;
  const Estimate* find(const std::string& name) const;
  /// The first value of the cell whose interval is none: open, on the border of the search, or of no width; null: each
  /// has one.
  const Estimate* undetermined() const;
};

/// Bayesian information criterion of each (Schwarz 1978): the smallest is preferred, a difference of 10
/// is decisive. They must be of the same record.
std::vector<double> informationCriteria(const std::vector<Identification>& models);

enum class Drift { kAuto, kOn, kOff };

struct IdentificationConfig {
  /// kAuto: a drift is taken when the record shows it, three standard deviations from zero.
  Drift drift = Drift::kAuto;
  int prony_terms = 0;
  bool intervals = true;  ///< by the profile of the likelihood; else from the Hessian alone
  /// m, position of the contact that is known beforehand, and its standard deviation: only for the
  /// comparison with the rivals, which would fit it elsewhere.
  double contact = 0, contact_deviation = std::numeric_limits<double>::infinity();
  /// Cells that a family's cell is compared with; none: no comparison. Not with Prony terms.
  std::shared_ptr<const std::vector<RivalCell>> rivals;
};

/// The samples of a record that a fit uses: none of a sensor that hangs, and means of neighbours, when
/// there are many.
ForceCurve identifiedCurve(const ForceCurve& record);

/// Fits a law to identifiedCurve(). Throws ConfigError when there is no contact in it or the fit fails.
Identification identify(const ForceCurve& curve, const std::shared_ptr<ElasticLaw>& law,
                        const IdentificationConfig& config);

}  // namespace microinjection
