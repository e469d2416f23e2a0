#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "base/config_reader.h"
#include "cell/estimation/force_path.h"
#include "cell/estimation/sample_history.h"

namespace microinjection {

/// Beliefs before the needle touches, and what a verdict needs.
struct CellEstimatorConfig {
  double modulus_deviation = 0.8;     ///< of the modulus's logarithm: moduli of one species differ by factors
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
/// included, and Gaussian priors of ln E, z_0 and the offset. Gauss-Newton with Cauchy's weights.
/// Not thread-safe.
class CellEstimator {
 public:
  /// `scene`: the prior; `cell`: its member of a family, in SI units, whose expected error is
  /// `member_error` (relative, median).
  CellEstimator(const Scene& scene, std::shared_ptr<const SurrogateData> cell, const CellEstimatorConfig& config);

  /// A new reading. `tip`: m, relative to the cell's centre. `force`: N, of the cell on the tip along
  /// the pipette. Cheap; does not fit.
  void add(double time, const Eigen::Vector3d& tip, double force);
  /// Fits; milliseconds.
  const CellEstimate& update();
  const CellEstimate& estimate() const { return estimate_; }
  /// Another cell, of the same prior.
  void reset();

 private:
  /// (ln(E / prior), z_0, offset) in units of the prior's deviations.
  using State = Eigen::Vector3d;

  struct Fit {
    State state = State::Zero();
    Eigen::Matrix3d normal = Eigen::Matrix3d::Identity();  ///< J^T W J with the prior
    Eigen::VectorXd residuals;                             ///< over their deviations, measured - predicted
    Eigen::VectorXd deviations;                            ///< N
  };

  /// Whether a reading is far from the median of the newest ones (Hampel's filter).
  bool isOutlier(double force) const;
  Fit fit(const State& start);
  void linearise(const State& state, Fit& fit, Eigen::MatrixXd& jacobian);
  double cost(const Fit& fit, double scale) const;
  void judge(const Fit& fit);
  struct Misfit {
    double found = 0;     ///< over the largest force
    double expected = 0;  ///< same, of noise alone
    bool contradicts = false;
  };
  Misfit misfitOf(const Fit& fit) const;
  std::string drifts() const;
  void setPrior(EstimateVerdict verdict, const std::string& reason);

  CellEstimatorConfig config_;
  double prior_modulus_, law_error_;
  ForcePath path_, shifted_;
  SampleHistory history_;
  State state_ = State::Zero();
  CellEstimate estimate_;
  std::vector<ForcePath::Point> points_, shifted_points_;
  static constexpr std::size_t kWindow = 7;
  std::array<double, kWindow> window_{};  ///< N, the newest readings, in a ring
  std::size_t received_ = 0;
  int repeated_ = 0;        ///< equal readings in a row
  int contradictions_ = 0;  ///< updates in a row
};

}  // namespace microinjection
