#include "operation/control/training_score.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "base/atomic_file.h"

namespace microinjection {
namespace {

constexpr char kHeader[] =
    "trainee,session,outcome,peak_force_N,deformation_m,lateral_error_m,time_s,punctures,volume_m3,force_points,"
    "deformation_points,lateral_points,time_points,punctures_points,volume_points,score\n";

constexpr double kStarted = 1e-6;  ///< m of the tip's motion that counts as start
constexpr double kGaps = 0.05;     ///< largest share of samples left out

/// Share of the points: 1 up to the reference, 0 from twice the reference. An exact measure has 1
/// at the reference, less by the relative difference.
double shareOf(const TrainingMeasure& measure) {
  if (!measure.exact) return std::clamp(2 - measure.value / measure.reference, 0.0, 1.0);
  if (measure.reference <= 0) return measure.value <= 0 ? 1 : 0;
  return std::max(0.0, 1 - std::abs(measure.value - measure.reference) / measure.reference);
}

bool inCell(InjectionState state) {
  return state == InjectionState::kContact || state == InjectionState::kIndent || state == InjectionState::kAspirate ||
         state == InjectionState::kPunctured || state == InjectionState::kInject;
}

std::string contentOf(const std::string& path) {
  if (!std::filesystem::exists(path)) return "";
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file) throw std::runtime_error(path + ": cannot be read");
  return text.str();
}

}  // namespace

TrainingTask TrainingTask::read(ConfigReader& reader) {
  TrainingTask task;
  reader.number("peak_force", task.peak_force, Range::positive());
  reader.number("deformation", task.deformation, Range::positive());
  reader.number("lateral_error", task.lateral_error, Range::positive());
  reader.number("time", task.time, Range::positive());
  reader.integer("punctures", task.punctures, Range::closed(0, 100));
  reader.number("volume", task.volume, Range::nonNegative());
  return task;
}

const char* toText(TrainingOutcome outcome) {
  constexpr const char* kWords[] = {"complete", "aborted", "invalid", "untouched"};
  return kWords[static_cast<int>(outcome)];
}

std::array<TrainingMeasure, 6> TrainingScore::measures(const TrainingTask& task) const {
  return {{{"peak_force_N", "peak force", "uN", 1e-6, peak_force, task.peak_force, 25, false},
           {"deformation_m", "deformation", "um", 1e-6, deformation, task.deformation, 15, false},
           {"lateral_error_m", "lateral error", "um", 1e-6, lateral_error, task.lateral_error, 20, false},
           {"time_s", "time", "s", 1, time, task.time, 10, false},
           {"punctures", "punctures", "", 1, double(punctures), double(task.punctures), 20, true},
           {"volume_m3", "volume", "pL", 1e-15, volume, task.volume, 10, true}}};
}

void TrainingSession::addGap() {
  if (state_ != InjectionState::kIdle || used_ > 0) ++left_out_;
}

void TrainingSession::add(const TraineeSample& sample) {
  if (!std::isfinite(sample.time) || !sample.tip.allFinite() || !sample.axis.allFinite() || !sample.force.allFinite() ||
      (sample.depth && !std::isfinite(*sample.depth))) {
    addGap();
    return;
  }
  state_ = sample.state;
  fault_ = fault_ || state_ == InjectionState::kFault;
  if (state_ != InjectionState::kIdle || used_ > 0) ++used_;
  count(sample);
  measured_.peak_force = std::max(measured_.peak_force, sample.force.norm());
  follow(sample);
  measureDepth(sample);
}

/// Adds the punctures and the volume since the last sample.
void TrainingSession::count(const TraineeSample& sample) {
  if (punctures_) measured_.punctures += sample.punctures - (sample.punctures < *punctures_ ? 0 : *punctures_);
  punctures_ = sample.punctures;
  if (!std::isfinite(sample.volume)) return;
  const bool through = state_ == InjectionState::kPunctured || state_ == InjectionState::kInject;
  if (volume_ && through) measured_.volume += sample.volume - *volume_;
  volume_ = sample.volume;
}

/// Measures the time from the needle's start to its last work.
void TrainingSession::follow(const TraineeSample& sample) {
  if (state_ == InjectionState::kIdle) return;
  if (!start_) start_ = sample.tip;
  moving_ = moving_ || (sample.tip - *start_).norm() > kStarted;
  if (!moving_) began_ = sample.time;
  if (state_ != InjectionState::kApproach) measured_.time = sample.time - began_;
}

void TrainingSession::measureDepth(const TraineeSample& sample) {
  if (!sample.depth) {
    entry_.reset();
    return;
  }
  touched_ = true;
  if (!entry_) entry_ = sample.tip + *sample.depth * sample.axis;
  if (measured_.punctures == 0) measured_.deformation = std::max(measured_.deformation, *sample.depth);
  if (!inCell(state_)) return;
  const Eigen::Vector3d displacement = sample.tip - *entry_;
  measured_.lateral_error =
      std::max(measured_.lateral_error, (displacement - displacement.dot(sample.axis) * sample.axis).norm());
}

void TrainingSession::computeScore(TrainingScore& score) const {
  const bool out = state_ == InjectionState::kIdle || state_ == InjectionState::kApproach;
  score.outcome = TrainingOutcome::kComplete;
  if (fault_ || !out) {
    score.outcome = TrainingOutcome::kAborted;
    score.reason = fault_ ? "the rig was at fault" : std::string("it ended in ") + toText(state_);
  }
  if (left_out_ > kGaps * (used_ + left_out_)) {
    score.outcome = TrainingOutcome::kInvalid;
    score.reason = "needle or force was not valid in " + std::to_string(left_out_) + " of " +
                   std::to_string(used_ + left_out_) + " moments";
  }
  if (!touched_) {
    score.outcome = TrainingOutcome::kUntouched;
    score.reason = "no cell was touched";
  }
}

TrainingScore TrainingSession::score(const TrainingTask& task) const {
  TrainingScore score = measured_;
  computeScore(score);
  if (score.outcome != TrainingOutcome::kComplete) return score;
  const auto measures = score.measures(task);
  std::transform(measures.begin(), measures.end(), score.points.begin(),
                 [](const TrainingMeasure& measure) { return measure.most * shareOf(measure); });
  return score;
}

void checkTrainingName(const std::string& text) {
  if (text.empty() || text.find_first_of(",\"\r\n") != std::string::npos) {
    throw std::invalid_argument("\"" + text + "\": must be a text without comma, quote and line break");
  }
}

void appendTrainingRow(const std::string& path, const std::string& trainee, const std::string& session,
                       const TrainingScore& score) {
  checkTrainingName(trainee);
  checkTrainingName(session);
  std::string content = contentOf(path);
  if (content.empty()) content = kHeader;
  if (content.rfind(kHeader, 0) != 0) throw std::runtime_error(path + ": is not a history of training sessions");
  if (content.back() != '\n') content += '\n';
  std::ostringstream row;
  row.precision(6);
  row << trainee << ',' << session << ',' << toText(score.outcome);
  for (const TrainingMeasure& measure : score.measures({})) row << ',' << measure.value;
  for (const double points : score.points) row << ',' << points;
  row << ',' << score.score() << '\n';
  writeFileAtomically(path, content + row.str());
}

}  // namespace microinjection
