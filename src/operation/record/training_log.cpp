#include "operation/record/training_log.h"

#include <iomanip>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "base/atomic_file.h"

namespace microinjection {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// Quotes a text for YAML: in a double-quoted line only `"` and `\` must be escaped.
std::string yamlQuoted(const std::string& text) {
  std::string result = "\"";
  for (const char letter : text)
    result += (letter == '"' || letter == '\\') ? std::string("\\") + letter : std::string(1, letter);
  return result + '"';
}

std::string toYaml(const TrainingConfig& config, const std::string& session, const TrainingScore& score, int left_out) {
  std::ostringstream out;
  out.precision(9);
  out << "trainee: " << yamlQuoted(config.trainee) << "\nsession: " << yamlQuoted(session)
      << "\noutcome: " << toText(score.outcome) << "\nreason: " << yamlQuoted(score.reason)
      << "\nscore: " << score.score() << "\nmoments_left_out: " << left_out << "\nmeasures:\n";
  const double* points = score.points.data();
  for (const TrainingMeasure& measure : score.measures(config.task)) {
    out << "  " << measure.key << ": {value: " << measure.value << ", reference: " << measure.reference
        << ", points: " << *points++ << ", of: " << measure.most << "}\n";
  }
  return out.str();
}

std::string toText(const TrainingConfig& config, const std::string& session, const TrainingScore& score) {
  std::ostringstream out;
  out << "training of " << config.trainee << ", session " << session << ": " << std::fixed;
  if (score.outcome == TrainingOutcome::kComplete) {
    out << std::setprecision(0) << score.score() << " of 100 points";
  } else {
    out << toText(score.outcome) << ", no points: " << score.reason;
  }
  if (score.outcome == TrainingOutcome::kUntouched) return out.str() + "; it is not in the history";
  const double* points = score.points.data();
  for (const TrainingMeasure& measure : score.measures(config.task)) {
    out << "\n  " << std::left << std::setw(14) << measure.name << std::right << std::setprecision(2) << std::setw(8)
        << measure.value / measure.scale << " of " << std::setw(6) << measure.reference / measure.scale << ' '
        << std::left << std::setw(2) << measure.unit << std::right << std::setprecision(1) << std::setw(8) << *points++
        << " of " << std::setprecision(0) << measure.most;
  }
  return out.str();
}

}  // namespace

TrainingConfig TrainingConfig::read(ConfigReader& reader) {
  TrainingConfig config;
  reader.text("trainee", config.trainee, ConfigReader::kRequired);
  reader.path("history", config.history, ConfigReader::kRequired);
  reader.choice("force", config.force, {"predicted", "measured"});
  reader.choice("punctures", config.punctures, {"cell", "felt"});
  ConfigReader task = reader.section("task");
  config.task = TrainingTask::read(task);
  try {
    if (!config.trainee.empty()) checkTrainingName(config.trainee);
  } catch (const std::invalid_argument& error) {
    reader.error("trainee", error.what());
  }
  return config;
}

int TrainingLog::puncturesOf(const SessionTable::Row& row) {
  if (config_.punctures == "felt") return row.punctures;
  const SessionTable::Cell& now = row.cell;
  // On return to an existing hole the cell reports its failed layers at once: they do not count
  // again.
  const bool old_hole = cell_ && cell_->layers_punctured == 0 && cell_->holes == now.holes;
  if (cell_ && !old_hole && now.layers_punctured > cell_->layers_punctured)
    cell_punctures_ += static_cast<int>(now.layers_punctured - cell_->layers_punctured);
  cell_ = now;
  return cell_punctures_;
}

void TrainingLog::add(const SessionTable::Row& row) {
  std::optional<Eigen::Vector3d> force = row.predicted;
  if (config_.force == "measured") {
    force.reset();
    if (row.measured) force = Eigen::Vector3d(row.measured->lateral, 0, row.measured->axial);
  }
  const int punctures = puncturesOf(row);
  if (!row.needle || !force) return session_.addGap();
  TraineeSample sample;
  sample.time = row.time;
  sample.tip = row.needle->tip;
  sample.axis = row.needle->axis;
  sample.force = *force;
  if (row.depth && *row.depth >= 0) sample.depth = row.depth;
  sample.state = injectionStateOf(row.injection).value_or(InjectionState::kIdle);
  sample.volume = row.volume.value_or(kUnknown);
  sample.punctures = punctures;
  session_.add(sample);
}

TrainingLog::Result TrainingLog::finish(const std::string& folder, const std::string& session) const {
  Result result;
  result.score = session_.score(config_.task);
  result.text = toText(config_, session, result.score);
  const auto attempt = [&result](const auto& write) {
    try {
      write();
      return true;
    } catch (const std::exception& error) {
      result.errors.push_back(error.what());
      return false;
    }
  };
  attempt([&] {
    writeFileAtomically(folder + "/training.yaml", toYaml(config_, session, result.score, session_.leftOut()));
  });
  result.in_history = result.score.outcome != TrainingOutcome::kUntouched &&
                      attempt([&] { appendTrainingRow(config_.history, config_.trainee, session, result.score); });
  return result;
}

}  // namespace microinjection
