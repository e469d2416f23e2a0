#pragma once

#include <Eigen/Core>
#include <array>
#include <numeric>
#include <optional>
#include <string>

#include "base/config_reader.h"
#include "operation/control/injection_state.h"

namespace microinjection {

/// References of a session. A measure up to its reference earns all its points. Above it the points
/// fall in proportion, to none at twice the reference.
struct TrainingTask {
  double peak_force = 8e-6;     ///< N
  double deformation = 45e-6;   ///< m
  double lateral_error = 3e-6;  ///< m
  double time = 20;             ///< s
  int punctures = 1;            ///< fewer or more by n of N cost the share n / N
  double volume = 0;            ///< m^3; more or less costs its share, too; 0: no injection

  static TrainingTask read(ConfigReader& reader);
};

/// A sample of a session.
struct TraineeSample {
  double time = 0;                                  ///< s, not decreasing
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();    ///< m
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< of the pipette, out of the cell
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< N, of the cell on the tip
  std::optional<double> depth;                      ///< m past the contact point, not negative; empty without contact
  InjectionState state = InjectionState::kIdle;
  double volume = 0;  ///< m^3, delivered so far; not finite: unknown
  int punctures = 0;  ///< so far; a fall begins a new count
};

/// Whether a session can be compared with others.
enum class TrainingOutcome {
  kComplete,  ///< contact, and the needle was out again at the end
  kAborted,   ///< ended in the cell or in FAULT: measured, no points
  kInvalid,   ///< needle or force invalid in too many samples: measured, no points
  kUntouched  ///< no contact: nothing to score
};
const char* toText(TrainingOutcome outcome);

/// A measure of a session with its reference, in SI units.
struct TrainingMeasure {
  const char* key;   ///< of training.yaml
  const char* name;  ///< for people
  const char* unit;  ///< for people
  double scale;      ///< SI units per `unit`
  double value, reference;
  double most;  ///< largest points
  bool exact;   ///< a value below the reference costs points, too
};

/// Measures and points of a session; `score` is the sum of the points, 0 to 100.
struct TrainingScore {
  TrainingOutcome outcome = TrainingOutcome::kUntouched;
  std::string reason;        ///< why it is not complete, for people; else empty
  double peak_force = 0;     ///< N, largest magnitude
  double deformation = 0;    ///< m, largest depth past the contact point before the first puncture (of all without one)
  double lateral_error = 0;  ///< m, in the cell: largest distance from the pipette's line through the contact point
  double time = 0;           ///< s, from the needle's start until it was out of the cell for the last time
  int punctures = 0;         ///< of membranes
  double volume = 0;         ///< m^3, delivered through a punctured membrane; leaks do not count
  std::array<double, 6> points = {};  ///< of each of measures()

  std::array<TrainingMeasure, 6> measures(const TrainingTask& task) const;
  double score() const { return std::accumulate(points.begin(), points.end(), 0.0); }
};

/// Scores a session from its stream of samples.
class TrainingSession {
 public:
  /// Leaves out samples that are not finite, and counts them.
  void add(const TraineeSample& sample);
  /// Counts a sample with an invalid needle or force.
  void addGap();
  TrainingScore score(const TrainingTask& task) const;

  int leftOut() const { return left_out_; }  ///< samples since the needle was ready

 private:
  void count(const TraineeSample& sample);
  void follow(const TraineeSample& sample);
  void measureDepth(const TraineeSample& sample);
  void computeScore(TrainingScore& score) const;

  TrainingScore measured_;
  InjectionState state_ = InjectionState::kIdle;
  bool touched_ = false, fault_ = false;
  int used_ = 0, left_out_ = 0;           ///< samples since the first that was not idle
  std::optional<Eigen::Vector3d> start_;  ///< m, tip before it started
  bool moving_ = false;                   ///< it has started
  double began_ = 0;                      ///< s
  std::optional<Eigen::Vector3d> entry_;  ///< m, tip at contact
  std::optional<double> volume_;          ///< m^3, of the last sample
  std::optional<int> punctures_;          ///< of the last sample
};

/// Appends a row to an operator's history, a CSV file with a row a session. `trainee` and
/// `session` (a date, for example) must not contain comma, quote or line break. The file is
/// replaced atomically; when two programs append at the same time, one row is lost.
/// @throws std::invalid_argument  for such a text
/// @throws std::runtime_error  when the file is another table or cannot be written
void appendTrainingRow(const std::string& path, const std::string& trainee, const std::string& session,
                       const TrainingScore& score);
/// @throws std::invalid_argument  when `text` cannot be the name of an operator or a session
void checkTrainingName(const std::string& text);

}  // namespace microinjection
