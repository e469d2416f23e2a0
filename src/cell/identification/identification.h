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
  /// Else the record does not bound it on that side: the border of the search is given.
  bool bounded_below = true, bounded_above = true;

  bool bounded() const { return bounded_below && bounded_above; }
  /// "below", "above" or "on both sides"; empty: bounded.
  std::string open() const;
};

/// What a record says about a cell under one model. A fit gives numbers also with a wrong model, so the result has what
/// shows that: intervals, the misfit of the model, and the comparison with cells of other layers.
struct Identification {
  std::string model;  ///< one line
  std::vector<Estimate> estimates;
  double noise = 0;        ///< N, robust deviation of the residuals
  double independent = 0;  ///< number of independent samples
  double deviation = 0;    ///< N, rms of the residuals without the largest fiftieth
  /// These three are N, and of tongues m.
  double misfit = 0;   ///< rms of the residuals' smooth part in contact: what the model cannot follow
  double scatter = 0;  ///< what noise alone would leave of it
  double size = 0;     ///< of the cell's force at the deepest sample; of the longest tongue over the shortest
  double depth = 0;    ///< m, of the deepest sample
  std::vector<std::string> warnings;  ///< what cannot be told apart, what is out of range
  Eigen::VectorXd residuals;          ///< N, of each sample
  std::optional<RivalComparison> rivals;

  /// Whether the model follows the record: the smooth part of the residuals is below 3 % of `size` or three times
  /// `scatter`, and no other cell follows the record clearly better.
  bool consistent() const;
  const Estimate* find(const std::string& name) const;
  /// The first value of the cell whose interval is none: open, on the border of the search, or of no width; null: each
  /// has one.
  const Estimate* undetermined() const;
};

/// Bayesian information criterion of each (Schwarz 1978): the smallest is preferred, a difference of 10
/// is decisive. They must be of the same record.
std::vector<double> informationCriteria(const std::vector<Identification>& models);

/// Whether the sensor's force drifts, linearly in time. A drift that is fitted without need takes a part of the cell's
/// force in a record with a short approach, and one that is left out becomes a part of the modulus.
enum class Drift { kAuto, kOn, kOff };

struct IdentificationConfig {
  /// kAuto: a drift is taken when the record shows it, three standard deviations from zero.
  Drift drift = Drift::kAuto;
  int prony_terms = 0;
  bool intervals = true;  ///< by the profile of the likelihood; else from the Hessian alone
  /// Of the force as a whole, relative, half of its interval of 95 %: of the sensor's spring constant or gain, which no
  /// record shows and which goes into the modulus.
  double calibration_error = 0;
  /// m, position of the contact that is known beforehand, and its standard deviation: only for the
  /// comparison with the rivals, which would fit it elsewhere.
  double contact = 0, contact_deviation = std::numeric_limits<double>::infinity();
  /// Cells that a family's cell is compared with; none: no comparison. Not with Prony terms.
  std::shared_ptr<const std::vector<RivalCell>> rivals;
};

/// The samples of a record that a fit uses: none of a sensor that hangs, and means of neighbours, when
/// there are many.
ForceCurve identifiedCurve(const ForceCurve& record);

/// Fits a law to identifiedCurve():
///
///     record --> identifiedCurve() --> guessContact() --> fit of CurveModel --> intervals --> misfit --> rivals
///                no frozen readings,   refused where      Cauchy's loss,        profile of    medians    other
///                2000 means at most    nothing rises      noise from the        the           of 12      layers
///                                      enough             residuals             likelihood    blocks
///
/// Contact point and offset are unknowns of the fit rather than read off the record first, because an error of the
/// contact would go into the modulus unseen. Cauchy's loss takes the weight of outliers away. The intervals are those
/// of the profile of the likelihood rather than of the Hessian, since the cost is not quadratic in the point where the
/// force begins. The correlation of the residuals widens them, because samples that follow each other say less than
/// their number, and so does the law's own error that of the modulus. In records 5 um deep at a noise of 10 nN, 97 % of
/// them cover the truth (doc/reference/benchmarks.md, Identify).
///
/// At this depth the force of a shell with a soft inside is mostly that of a homogeneous cell, so a good fit alone says
/// nothing about the layers: `rivals` compares the fit with cells of other layers.
///
/// Throws ConfigError when there is no contact in the curve, fewer than 24 samples are in contact, the fit does not
/// converge, or Prony terms are asked of a record without a rising time.
Identification identify(const ForceCurve& curve, const std::shared_ptr<ElasticLaw>& law,
                        const IdentificationConfig& config);

}  // namespace microinjection
