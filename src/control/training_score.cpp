#include "control/training_score.h"

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
    "operator,session,peak_force_N,deformation_m,lateral_error_m,time_s,punctures,volume_m3,force_points,"
    "deformation_points,lateral_points,time_points,punctures_points,volume_points,score\n";

/// Of the points: all up to the reference, none from twice the reference.
double within(double value, double reference) { return std::clamp(2 - value / reference, 0.0, 1.0); }
/// All at the reference, less by the relative difference.
double at(double value, double reference) {
  if (reference <= 0) return value <= 0 ? 1 : 0;
  return std::max(0.0, 1 - std::abs(value - reference) / reference);
}

bool inCell(InjectionState state) {
  return state == InjectionState::kContact || state == InjectionState::kIndent || state == InjectionState::kPunctured ||
         state == InjectionState::kInject;
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

void TrainingSession::add(const TrainingSample& sample) {
  if (!std::isfinite(sample.time) || !sample.tip.allFinite() || !sample.axis.allFinite() ||
      !std::isfinite(sample.volume))
    return;
  if (!volume_before_) volume_before_ = sample.volume;
  if (!punctures_before_) punctures_before_ = sample.punctures;
  measured_.volume = sample.volume - *volume_before_;
  measured_.punctures = sample.punctures - *punctures_before_;
  if (sample.force.allFinite()) measured_.peak_force = std::max(measured_.peak_force, sample.force.norm());
  if (sample.state != InjectionState::kIdle) {
    if (!began_) began_ = sample.time;
    measured_.time = sample.time - *began_;
  }
  if (!sample.depth || !std::isfinite(*sample.depth)) {
    entry_.reset();
    return;
  }
  if (!entry_) entry_ = sample.tip + *sample.depth * sample.axis;
  if (measured_.punctures == 0) measured_.deformation = std::max(measured_.deformation, *sample.depth);
  if (!inCell(sample.state)) return;
  const Eigen::Vector3d way = sample.tip - *entry_;
  measured_.lateral_error = std::max(measured_.lateral_error, (way - way.dot(sample.axis) * sample.axis).norm());
}

TrainingScore TrainingSession::score(const TrainingTask& task) const {
  TrainingScore score = measured_;
  score.points = {};
  if (!began_) return score;  // nothing was done
  score.points.force = kTrainingPoints.force * within(score.peak_force, task.peak_force);
  score.points.deformation = kTrainingPoints.deformation * within(score.deformation, task.deformation);
  score.points.lateral = kTrainingPoints.lateral * within(score.lateral_error, task.lateral_error);
  score.points.time = kTrainingPoints.time * within(score.time, task.time);
  score.points.punctures = kTrainingPoints.punctures * at(score.punctures, task.punctures);
  score.points.volume = kTrainingPoints.volume * at(score.volume, task.volume);
  return score;
}

void appendTrainingRow(const std::string& path, const std::string& operator_name, const std::string& session,
                       const TrainingScore& score) {
  for (const std::string& text : {operator_name, session}) {
    if (text.empty() || text.find_first_of(",\"\r\n") != std::string::npos) {
      throw std::invalid_argument("\"" + text + "\": must be a text without comma, quote and line break");
    }
  }
  std::string content = contentOf(path);
  if (content.empty()) content = kHeader;
  if (content.rfind(kHeader, 0) != 0) throw std::runtime_error(path + ": is not a history of training sessions");
  if (content.back() != '\n') content += '\n';
  std::ostringstream row;
  row.precision(6);
  const TrainingScore::Points& points = score.points;
  row << operator_name << ',' << session << ',' << score.peak_force << ',' << score.deformation << ','
      << score.lateral_error << ',' << score.time << ',' << score.punctures << ',' << score.volume << ','
      << points.force << ',' << points.deformation << ',' << points.lateral << ',' << points.time << ','
      << points.punctures << ',' << points.volume << ',' << score.score() << '\n';
  writeFileAtomically(path, content + row.str());
}

}  // namespace microinjection
