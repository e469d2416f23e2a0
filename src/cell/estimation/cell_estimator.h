#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "base/config_reader.h"
#include "cell/estimation/force_path.h"
#include "cell/estimation/image_contact.h"
#include "cell/estimation/misfit.h"
#include "cell/estimation/reading_filter.h"
#include "cell/estimation/rival_watch.h"
#include "cell/estimation/sample_history.h"

namespace microinjection {

/// Beliefs before the needle touches, and what a verdict needs.
struct CellEstimatorConfig {
  double modulus_deviation = 0.8;     ///< of the modulus's logarithm: moduli of one species differ by factors
  double next_deviation = 0.05;       ///< same, from one indentation to the next
  double contact_deviation = 0.5e-6;  ///< m, of the cell's height
  double offset_deviation = 50e-9;    ///< N, of the tared sensor
  double sensor_noise = 10e-9;        ///< N, of a reading, until the readings themselves show it
  double sensor_floor = 3e-9;         ///< N, of what does not average out: drift, 1/f noise
  double force_error = 0.01;          ///< relative, of the model from sample to sample
  double converged_interval = 0.05;   ///< relative half width of the modulus's 95 % interval
  double misfit = 0.03;               ///< of the largest force: a smaller smooth residual is no contradiction
  double drift_limit = 20e-9;         ///< N/s, of the force before contact
  SampleHistoryConfig history;

  void read(ConfigReader& reader);
};

enum class EstimateVerdict {
  kPrior,         ///< nothing learned yet
  kLearning,      ///< the interval is still wide
  kConverged,     ///< the interval is narrow
  kInconsistent,  ///< the force is not that of a cell of this model; the values are those of the prior
};

/// "prior", "learning", "converged" or "inconsistent".
const char* toText(EstimateVerdict verdict);

struct CellEstimate {
  EstimateVerdict verdict = EstimateVerdict::kPrior;
  std::string reason;                                        ///< for people
  double modulus = 0, modulus_low = 0, modulus_high = 0;     ///< Pa, of the outermost layer; interval of 95 %
  double contact = 0;                                        ///< m, of the cell's surface above where it is modelled
  double offset = 0;                                         ///< N, of the sensor
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< of ln(modulus), contact (m), offset (N)
  double depth = 0;                                          ///< m, deepest so far
  int samples = 0;                                           ///< in contact
  double misfit = 0;  ///< smooth part of the residuals in contact over the largest force: what the model cannot follow
};

/// Finds the modulus of the cell that a needle indents, while it does so.
///
/// All samples of the indentation are fitted anew at each update (full-information moving horizon):
///
///     F_i = E f(z_i - z_0) + offset,
///
/// with f the family's converged force for a modulus of 1 Pa on the tip's path, its relaxation
/// included, and Gaussian priors of ln E, z_0 and the offset. Images that show the dimple narrow that of z_0.
/// Damped Gauss-Newton steps with Cauchy's weights. Not thread-safe.
///
/// All samples are kept, because an outlier, a frozen reading or a misplaced contact shows only once more of the course
/// of the force is known, and a filter cannot weigh its early readings anew. An iterated Kalman filter with the same
/// prior and model was measured beside the fit (doc/reference/benchmarks.md, The cell estimator; error of the modulus 5
/// um deep, median):
///
///     cells                    fit      filter    its intervals that cover: fit, filter
///     homogeneous              0.6 %    1.2 %     100, 93 %
///     zona                     1.5 %    1.3 %     95, 90 %
///     with 3 % of outliers     1.0 %    2.6 %     100, 90 %
///     with frozen readings     1.8 %    2.2 %     90, 70 %
///
/// The fit costs up to 2.6 ms an update, the comparison with rivals included, and the filter up to 0.4 ms without one.
/// SampleHistory bounds the cost: the longer the indentation, the coarser the samples.
///
///     prior <------> learning <------> converged       by the interval of the modulus; prior, too, while the
///                        |                 |           sensor drifts before the contact
///                        `--------+--------'
///                                 v
///                            inconsistent              three updates in a row contradict the model, or a rival
///                                                      follows the force better
///
/// A contradiction stays until beginNext() or forgetSince(), so that the served cell does not go to and fro, and the
/// values are then those of the scene again.
class CellEstimator {
 public:
  /// `scene`: the prior; `cell`: its member of a family, in SI units, whose expected error is
  /// `member_error` (relative, median). `rivals`: cells with other layers; where one of them follows the
  /// force clearly better, the estimate is inconsistent.
  CellEstimator(const Scene& scene, std::shared_ptr<const SurrogateData> cell, const CellEstimatorConfig& config,
                std::shared_ptr<const std::vector<RivalCell>> rivals = nullptr);

  /// A new reading. `tip`: m, relative to the cell's centre. `force`: N, of the cell on the tip along
  /// the pipette. Cheap; does not fit. Returns why such readings are not learned from; empty if they are.
  std::string add(double time, const Eigen::Vector3d& tip, double force);
  /// What images show of the surface's height, beside the force: a part of the prior. Empty: nothing.
  void seeContact(const std::optional<ImageContact::Height>& seen);
  /// Fits; milliseconds.
  const CellEstimate& update();
  const CellEstimate& estimate() const { return estimate_; }
  /// Takes back the readings since `time` (s), as after a puncture, and fits again.
  void forgetSince(double time);
  /// The same cell again, or one like it: what was learned of the modulus is the next prior, with a
  /// deviation of at least next_deviation. A force that contradicts it makes that prior wide again.
  void beginNext();

 private:
  /// (ln(E / prior), z_0, offset) in units of the priors' deviations.
  using State = Eigen::Vector3d;

  /// Gaussian, in these units.
  struct Prior {
    State mean = State::Zero(), precision = State::Ones();
    double cost(const State& state) const { return 0.5 * (state - mean).cwiseAbs2().dot(precision); }
  };

  struct Fit {
    State state = State::Zero();
    Eigen::Matrix3d normal = Eigen::Matrix3d::Identity();  ///< J^T W J with the prior
    std::vector<ForcePath::Point> points;                  ///< of the scene's modulus
    Eigen::VectorXd residuals;                             ///< over their deviations, measured - predicted
    Eigen::VectorXd deviations;                            ///< N
    bool touches() const;
  };

  Fit fit(const State& start);
  void linearise(const State& state, Fit& fit, Eigen::MatrixXd& jacobian);
  double cost(const Fit& fit, double scale) const;
  void judge(const Fit& fit);
  /// Why the force before contact cannot be learned from; empty if it can.
  std::string drift(const Fit& fit) const;
  bool contradicts(const Misfit& misfit) const;
  CellEstimate estimateOf(const Fit& fit, const Misfit& misfit) const;
  void setPrior(EstimateVerdict verdict, const std::string& reason);
  double noise() const;                        ///< N, of a reading
  double modulusOf(const State& state) const;  ///< Pa

  CellEstimatorConfig config_;
  double scene_modulus_, law_error_;        ///< Pa; relative
  double prior_modulus_, prior_deviation_;  ///< Pa; of the logarithm
  ForcePath path_, shifted_;
  SampleHistory history_;
  State state_ = State::Zero();
  Prior prior_;
  CellEstimate estimate_;
  std::vector<ForcePath::Point> shifted_points_;
  ReadingFilter filter_;
  RivalWatch watch_;
  int contradictions_ = 0;  ///< updates in a row; from kPersistent on they stay
};

}  // namespace microinjection
