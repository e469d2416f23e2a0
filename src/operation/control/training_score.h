#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "base/config_reader.h"
#include "operation/control/injection_state.h"

namespace microinjection {

/// What a session shall be like. A measure that meets its reference earns all its points; what exceeds it loses them
/// in proportion, and at twice the reference there are none left.
struct TrainingTask {
  double peak_force = 8e-6;     ///< N
  double deformation = 45e-6;   ///< m
  double lateral_error = 3e-6;  ///< m
  double time = 20;             ///< s
  int punctures = 1;            ///< fewer or more by n of N cost the share n / N
  double volume = 0;            ///< m^3; more or less costs its share as well; 0: nothing is to be injected

  static TrainingTask read(ConfigReader& reader);
};

/// One moment of a session.
struct TrainingSample {
  double time = 0;                                  ///< s, not decreasing
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();    ///< m
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< of the pipette, out of the cell
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< N, of the cell on the tip
  std::optional<double> depth;                      ///< m past the touch, not negative; empty where the tip is not
  InjectionState state = InjectionState::kIdle;
  double volume = 0;  ///< m^3, delivered until now; not finite: not known
  int punctures = 0;  ///< until now; a fall begins a new count
};

/// What a session is worth as one to be compared with others.
enum class TrainingOutcome {
  kComplete,  ///< touched, and the needle was out again at the end
  kAborted,   ///< ended in the cell, or the rig was at fault: measured, no points
  kInvalid,   ///< too many moments in which needle or force was not valid: measured, no points
  kUntouched  ///< no cell was touched: nothing to score
};
const char* toText(TrainingOutcome outcome);

/// A session in numbers. Largest points: see kTrainingPoints; `score` is their sum, 0 to 100.
struct TrainingScore {
  struct Points {
    double force = 0, deformation = 0, lateral = 0, time = 0, punctures = 0, volume = 0;
    double sum() const { return force + deformation + lateral + time + punctures + volume; }
  };

  TrainingOutcome outcome = TrainingOutcome::kUntouched;
  std::string reason;        ///< why it is not complete, for people; empty where it is
  double peak_force = 0;     ///< N, largest magnitude
  double deformation = 0;    ///< m, deepest past the touch before the first puncture (of all where there is none)
  double lateral_error = 0;  ///< m, farthest off the line along the pipette through the touch, in the cell
  double time = 0;           ///< s, from when the needle set out until it was out of the cell for the last time
  int punctures = 0;         ///< of membranes
  double volume = 0;         ///< m^3, delivered through a punctured membrane; what leaks elsewhere is not counted
  Points points;
  double score() const { return points.sum(); }
};

constexpr TrainingScore::Points kTrainingPoints = {25, 15, 20, 10, 20, 10};

/// Scores a session from its stream of samples.
class TrainingSession {
 public:
  /// What is not finite is left out, and counted.
  void add(const TrainingSample& sample);
  /// A moment in which needle or force was not valid.
  void addGap();
  TrainingScore score(const TrainingTask& task) const;

  int leftOut() const { return left_out_; }  ///< moments since the needle was ready

 private:
  void count(const TrainingSample& sample);
  void follow(const TrainingSample& sample);
  void measureDepth(const TrainingSample& sample);
  void computeScore(TrainingScore& score) const;

  TrainingScore measured_;
  InjectionState state_ = InjectionState::kIdle;
  bool touched_ = false, fault_ = false;
  int used_ = 0, left_out_ = 0;           ///< moments since the first that was not idle
  std::optional<Eigen::Vector3d> start_;  ///< m, tip before it set out
  bool moving_ = false;                   ///< it has set out
  double began_ = 0;                      ///< s
  std::optional<Eigen::Vector3d> entry_;  ///< m, where the tip was at the touch
  std::optional<double> volume_;          ///< m^3, of the sample before
  std::optional<int> punctures_;          ///< of the sample before
};

/// The operator's history: a CSV file, a row a session. `operator_name` and `session` (its date, say) must hold neither
/// comma, quote nor line break. Appends and replaces the file at once (of two programs that append at the same
/// moment one row is lost).
/// @throws std::invalid_argument  for such a text; std::runtime_error: the file is another table or cannot be written
void appendTrainingRow(const std::string& path, const std::string& operator_name, const std::string& session,
                       const TrainingScore& score);
/// @throws std::invalid_argument  where `text` cannot be an operator's or a session's name
void checkTrainingName(const std::string& text);

}  // namespace microinjection
